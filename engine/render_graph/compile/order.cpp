// Orders the groups so that each comes after what it depends on; among those that could come next, the one declared
// first.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>
#include <functional>
#include <queue>

namespace splice::graph {

void order(Compilation& compilation) {
    const auto passes = static_cast<uint32_t>(compilation.declaration.passes.size());
    std::vector<uint32_t>& group_of = compilation.group_of;
    uint32_t groups = 0;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        if (group_of[pass] != none) groups = std::max(groups, group_of[pass] + 1);
    }

    // merge() numbers groups by their first pass, so the number of a group is its rank in the declaration.
    std::vector<uint32_t> first_member(groups + 1, 0), first_successor(groups + 1, 0), waiting_for(groups, 0);
    const auto each_edge = [&](const auto& function) {
        for (uint32_t pass = 0; pass < passes; ++pass) {
            for (const Edge& edge : compilation.predecessors_of(pass)) {
                if (group_of[edge.from] != group_of[pass]) function(group_of[edge.from], group_of[pass]);
            }
        }
    };
    each_edge([&](uint32_t from, uint32_t to) {
        ++first_successor[from + 1];
        ++waiting_for[to];
    });
    for (uint32_t pass = 0; pass < passes; ++pass) {
        if (group_of[pass] != none) ++first_member[group_of[pass] + 1];
    }
    for (uint32_t group = 0; group < groups; ++group) {
        first_successor[group + 1] += first_successor[group];
        first_member[group + 1] += first_member[group];
    }
    std::vector<uint32_t> successors(first_successor[groups]), members(first_member[groups]);
    std::vector<uint32_t> next_successor = first_successor, next_member = first_member;
    each_edge([&](uint32_t from, uint32_t to) { successors[next_successor[from]++] = to; });
    for (uint32_t pass = 0; pass < passes; ++pass) {
        if (group_of[pass] != none) members[next_member[group_of[pass]]++] = pass;
    }

    std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>> ready;
    for (uint32_t group = 0; group < groups; ++group) {
        if (waiting_for[group] == 0) ready.push(group);
    }
    Plan& plan = compilation.plan;
    plan.order.reserve(members.size());
    plan.groups.reserve(groups);
    while (!ready.empty()) {
        const uint32_t group = ready.top();
        ready.pop();
        Group planned;
        planned.passes = {static_cast<uint32_t>(plan.order.size()), first_member[group + 1] - first_member[group]};
        for (uint32_t i = first_member[group]; i < first_member[group + 1]; ++i)
            plan.order.push_back(members[i]);
        plan.groups.push_back(planned);
        for (uint32_t i = first_successor[group]; i < first_successor[group + 1]; ++i) {
            if (--waiting_for[successors[i]] == 0) ready.push(successors[i]);
        }
    }
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes))
            group_of[pass] = group;
    }
}

}  // namespace splice::graph
