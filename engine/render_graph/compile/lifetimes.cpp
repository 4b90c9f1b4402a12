// Where each resource is used: one entry a group, in order, with all passes of the group together.
#include "engine/render_graph/compile/compilation.h"

#include <utility>

namespace splice::graph {
namespace {

void add_access(GroupUse& use, const Access& access, const ResourceDeclaration& resource, bool first) {
    const Scope scope = scope_of(access.kind, access.stages);
    const VkImageLayout layout = layout_of(access.kind, resource.image.format);
    if (first) {
        use.entry_layout = layout;
        use.needs_contents = !is_write(access.kind) || access.contents == ContentsKind::keep;
    }
    use.entry |= scope;
    use.exit |= scope;
    use.exit_layout = layout;
    use.writes = use.writes || is_write(access.kind);
}

}  // namespace

void find_lifetimes(Compilation& compilation) {
    const Declaration& declaration = compilation.declaration;
    Plan& plan = compilation.plan;
    const size_t resources = declaration.resources.size();
    plan.resources.assign(resources, {});

    // First walk: count uses and note usage; second walk: fill them in.
    compilation.uses_of.assign(resources, {});
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes)) {
            for (const Access& access : compilation.graph.accesses(pass)) {
                PlannedResource& planned = plan.resources[access.resource];
                const ResourceDeclaration& declared = declaration.resources[access.resource];
                if (declared.kind == ResourceKind::image) {
                    planned.image_usage |= image_usage(access.kind, declared.image.format);
                } else {
                    planned.buffer_usage |= traits_of(access.kind).buffer_usage;
                }
                if (planned.lifetime.last_group == group) continue;
                if (planned.lifetime.first_group == none) planned.lifetime.first_group = group;
                planned.lifetime.last_group = group;
                ++compilation.uses_of[access.resource].count;
            }
        }
    }
    uint32_t total = 0;
    for (Range& range : compilation.uses_of) {
        range.first = total;
        total += std::exchange(range.count, 0);
    }
    compilation.uses.resize(total);
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes)) {
            for (const Access& access : compilation.graph.accesses(pass)) {
                Range& range = compilation.uses_of[access.resource];
                const bool first = range.count == 0 || compilation.uses[range.first + range.count - 1].group != group;
                if (first) ++range.count;
                GroupUse& use = compilation.uses[range.first + range.count - 1];
                use.group = group;
                add_access(use, access, declaration.resources[access.resource], first);
            }
        }
    }
}

}  // namespace splice::graph
