// Orders the groups so that each comes after what it depends on; among those that could come next, the one declared
// first, or a random one where CompileOptions::random_order asks for it.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <utility>

namespace splice::graph {
namespace {

/// The groups that could come next.
class ReadyGroups {
  public:
    explicit ReadyGroups(const std::optional<uint64_t>& seed)
        : random_(seed.has_value()), generator_(seed.value_or(0)) {}
    bool empty() const { return groups_.empty(); }
    void push(uint32_t group) {
        groups_.push_back(group);
        if (!random_) std::push_heap(groups_.begin(), groups_.end(), std::greater<>());
    }
    uint32_t pop() {
        if (random_) {
            std::swap(groups_[generator_() % groups_.size()], groups_.back());
        } else {
            std::pop_heap(groups_.begin(), groups_.end(), std::greater<>());
        }
        const uint32_t group = groups_.back();
        groups_.pop_back();
        return group;
    }

  private:
    bool random_;
    std::minstd_rand generator_;  // its sequence is fixed by the standard: one seed, one order everywhere
    std::vector<uint32_t> groups_;
};

/// The passes of each group, ascending, as groups() + 1 starts into a flat list.
struct Members {
    std::vector<uint32_t> starts, passes;
    uint32_t groups() const { return static_cast<uint32_t>(starts.size() - 1); }
};

Members find_members(const std::pmr::vector<uint32_t>& group_of) {
    Members members;
    members.starts.assign(1, 0);
    uint32_t total = 0;
    for (const uint32_t group : group_of) {
        if (group == none) continue;
        if (group + 2 > members.starts.size()) members.starts.resize(group + 2, 0);
        ++members.starts[group + 1];
        ++total;
    }
    std::partial_sum(members.starts.begin(), members.starts.end(), members.starts.begin());
    members.passes.resize(total);
    std::vector<uint32_t> next = members.starts;
    for (uint32_t pass = 0; pass < group_of.size(); ++pass) {
        if (group_of[pass] != none) members.passes[next[group_of[pass]]++] = pass;
    }
    return members;
}

/// Calls function(from, to) for each dependency between two groups.
template <typename Function>
void each_dependency(const Compilation& compilation, const Function& function) {
    const std::pmr::vector<uint32_t>& group_of = compilation.group_of;
    for (uint32_t pass = 0; pass < group_of.size(); ++pass) {
        for (const Edge& edge : compilation.predecessors_of(pass)) {
            if (group_of[edge.from] != group_of[pass]) function(group_of[edge.from], group_of[pass]);
        }
    }
}

/// merge() numbers groups by their first pass, so the number of a group is its rank in the declaration.
bool declaration_order_is_valid(const Compilation& compilation) {
    bool valid = true;
    each_dependency(compilation, [&](uint32_t from, uint32_t to) { valid = valid && from < to; });
    return valid;
}

std::vector<uint32_t> sort_groups(const Compilation& compilation, uint32_t groups) {
    std::vector<uint32_t> sorted(groups);
    std::iota(sorted.begin(), sorted.end(), 0);
    if (!compilation.options.random_order && declaration_order_is_valid(compilation)) return sorted;
    std::vector<uint32_t> first_successor(groups + 1, 0), waiting_for(groups, 0);
    each_dependency(compilation, [&](uint32_t from, uint32_t to) {
        ++first_successor[from + 1];
        ++waiting_for[to];
    });
    std::partial_sum(first_successor.begin(), first_successor.end(), first_successor.begin());
    std::vector<uint32_t> successors(first_successor[groups]), next = first_successor;
    each_dependency(compilation, [&](uint32_t from, uint32_t to) { successors[next[from]++] = to; });

    ReadyGroups ready(compilation.options.random_order);
    for (uint32_t group = 0; group < groups; ++group) {
        if (waiting_for[group] == 0) ready.push(group);
    }
    for (size_t position = 0; !ready.empty(); ++position) {
        const uint32_t group = sorted[position] = ready.pop();
        for (uint32_t i = first_successor[group]; i < first_successor[group + 1]; ++i) {
            if (--waiting_for[successors[i]] == 0) ready.push(successors[i]);
        }
    }
    return sorted;
}

}  // namespace

void order(Compilation& compilation) {
    const Members members = find_members(compilation.group_of);
    Plan& plan = compilation.plan;
    plan.order.reserve(members.passes.size());
    plan.groups.reserve(members.groups());
    for (const uint32_t group : sort_groups(compilation, members.groups())) {
        Group planned;
        planned.passes = {static_cast<uint32_t>(plan.order.size()), members.starts[group + 1] - members.starts[group]};
        for (uint32_t i = members.starts[group]; i < members.starts[group + 1]; ++i) {
            plan.order.push_back(members.passes[i]);
            compilation.group_of[members.passes[i]] = static_cast<uint32_t>(plan.groups.size());
        }
        plan.groups.push_back(planned);
    }
}

}  // namespace splice::graph
