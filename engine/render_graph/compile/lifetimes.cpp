// Where each resource is used: one entry a group, in order, with all passes of the group together.
#include "engine/render_graph/compile/compilation.h"

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
    std::vector<uint32_t> counts(resources, 0), last_group(resources, none);
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes)) {
            for (const Access& access : compilation.graph.accesses(pass)) {
                PlannedResource& planned = plan.resources[access.resource];
                planned.image_usage |= image_usage(access.kind);
                if (layout_of(access.kind, declaration.resources[access.resource].image.format) ==
                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL) {
                    // Vulkan wants it for this layout, even of images that are never attached.
                    planned.image_usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
                }
                planned.buffer_usage |= buffer_usage(access.kind);
                if (last_group[access.resource] == group) continue;
                last_group[access.resource] = group;
                if (planned.lifetime.first_group == none) planned.lifetime.first_group = group;
                planned.lifetime.last_group = group;
                ++counts[access.resource];
            }
        }
    }
    compilation.uses_of.resize(resources);
    uint32_t total = 0;
    for (size_t resource = 0; resource < resources; ++resource) {
        const bool image = declaration.resources[resource].kind == ResourceKind::image;
        (image ? plan.resources[resource].buffer_usage : plan.resources[resource].image_usage) = 0;
        compilation.uses_of[resource] = {total, 0};
        total += counts[resource];
    }
    compilation.uses.resize(total);
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes)) {
            for (const Access& access : compilation.graph.accesses(pass)) {
                Range& range = compilation.uses_of[access.resource];
                const bool first = range.count == 0 || compilation.uses[range.first + range.count - 1].group != group;
                if (first) {
                    ++range.count;
                    GroupUse& use = compilation.uses[range.first + range.count - 1];
                    use.resource = access.resource;
                    use.group = group;
                }
                add_access(compilation.uses[range.first + range.count - 1], access,
                           declaration.resources[access.resource], first);
            }
        }
    }
}

}  // namespace splice::graph
