// Turns each group of graphics passes into a render pass: attachments with what is loaded and stored, subpasses, and
// the dependencies between them.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>
#include <utility>

namespace splice::graph {
namespace {

/// One use of an attachment by one subpass.
struct SubpassUse {
    uint32_t attachment, subpass;
    Scope scope;
    bool write;
};

class RenderPassPlanner {
  public:
    explicit RenderPassPlanner(Compilation& compilation)
        : compilation_(compilation),
          plan_(compilation.plan),
          index_(compilation.declaration.resources.size(), none),
          next_use_(compilation.declaration.resources.size(), 0) {
        plan_.render_passes.reserve(plan_.groups.size());
        plan_.subpasses.reserve(plan_.order.size());
        plan_.attachments.reserve(plan_.resources.size());
        plan_.references.reserve(plan_.resources.size());
    }

    void plan_group(uint32_t group) {
        RenderPass render_pass;
        render_pass.attachments.first = static_cast<uint32_t>(plan_.attachments.size());
        render_pass.subpasses.first = static_cast<uint32_t>(plan_.subpasses.size());
        uses_.clear();
        for (const uint32_t pass : slice(plan_.order, plan_.groups[group].passes)) {
            add_subpass(pass, render_pass);
        }
        for (uint32_t i = 0; i < render_pass.attachments.count; ++i) {
            Attachment& attachment = plan_.attachments[render_pass.attachments.first + i];
            finish_attachment(attachment, group);
            index_[attachment.resource] = none;
        }
        if (render_pass.subpasses.count > 1) {
            sort_uses();
            add_preserved(render_pass);
            add_dependencies(render_pass);
        }
        plan_.groups[group].render_pass = static_cast<uint32_t>(plan_.render_passes.size());
        plan_.render_passes.push_back(render_pass);
    }

  private:
    const ResourceDeclaration& resource(uint32_t index) const { return compilation_.declaration.resources[index]; }

    void add_subpass(uint32_t pass, RenderPass& render_pass) {
        Subpass subpass;
        subpass.pass = pass;
        const auto collect = [&](auto wanted) {
            Range range{static_cast<uint32_t>(plan_.references.size()), 0};
            const PassDeclaration& declared = compilation_.declaration.passes[pass];
            for (uint32_t i = 0; i < declared.access_count; ++i) {
                const uint32_t index = declared.first_access + i;
                const Access& access = compilation_.declaration.accesses[index];
                if (!wanted(access.kind)) continue;
                plan_.references.push_back(reference(access, index, render_pass));
                ++range.count;
            }
            return range;
        };
        subpass.colours = collect([](AccessKind kind) { return kind == AccessKind::colour_attachment; });
        subpass.depth_stencil = collect([](AccessKind kind) {
            return kind == AccessKind::depth_stencil_attachment || kind == AccessKind::depth_stencil_read;
        });
        subpass.inputs = collect([](AccessKind kind) { return kind == AccessKind::input_attachment; });
        plan_.subpasses.push_back(subpass);
        ++render_pass.subpasses.count;
    }

    AttachmentReference reference(const Access& access, uint32_t access_index, RenderPass& render_pass) {
        const ResourceDeclaration& image = resource(access.resource);
        const VkImageLayout layout = layout_of(access.kind, image.image.format);
        uint32_t& index = index_[access.resource];
        if (index == none) {
            index = render_pass.attachments.count++;
            Attachment attachment;
            attachment.resource = access.resource;
            attachment.initial_layout = layout;
            attachment.load = !is_write(access.kind) || access.contents == ContentsKind::keep
                                  ? VK_ATTACHMENT_LOAD_OP_LOAD
                                  : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            if (access.contents == ContentsKind::clear) {
                attachment.load = VK_ATTACHMENT_LOAD_OP_CLEAR;
                attachment.clear_access = access_index;
            }
            plan_.attachments.push_back(attachment);
        }
        plan_.attachments[render_pass.attachments.first + index].final_layout = layout;
        if (render_pass.width == 0 || access.kind != AccessKind::input_attachment) {
            render_pass.width = image.image.width;
            render_pass.height = image.image.height;
            render_pass.layers = image.image.layers;
            render_pass.samples = image.image.samples;
        }
        uses_.push_back(
            {index, render_pass.subpasses.count, scope_of(access.kind, access.stages), is_write(access.kind)});
        const bool input = access.kind == AccessKind::input_attachment;
        return {index, layout, input ? gpu::format_aspects(image.image.format) : 0};
    }

    bool wanted_after_frame(uint32_t index, bool written) const {
        const ResourceDeclaration& declared = resource(index);
        if (declared.imported) return !written || compilation_.declaration.import_of(index).wanted;
        // In the next frame the passes of this one read it.
        return declared.history == HistoryRole::current && plan_.resources[index - 1].lifetime.first_group != none;
    }

    void finish_attachment(Attachment& attachment, uint32_t group) {
        const ResourceDeclaration& declared = resource(attachment.resource);
        const std::span<GroupUse> uses = compilation_.uses_of_resource(attachment.resource);
        uint32_t& position = next_use_[attachment.resource];
        while (uses[position].group != group)
            ++position;  // groups come in order: each use is passed once
        GroupUse& use = uses[position];
        const bool last = position + 1 == uses.size();
        const bool wanted =
            last ? wanted_after_frame(attachment.resource, use.writes) : uses[position + 1].needs_contents;
        if (!use.writes && attachment.load == VK_ATTACHMENT_LOAD_OP_LOAD) {
            attachment.store = VK_ATTACHMENT_STORE_OP_NONE;  // only read: memory still holds it
        } else {
            attachment.store = wanted ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
        }
        const VkFormat format = declared.image.format;
        if ((gpu::format_aspects(format) & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) {
            attachment.stencil_load = attachment.load;
            attachment.stencil_store = attachment.store;
        }
        use.entry |= load_scope(format, attachment.load);
        use.exit |= load_scope(format, attachment.load);
        use.exit |= store_scope(format, attachment.store);
        use.entry_layout = attachment.initial_layout;
        use.exit_layout = attachment.final_layout;

        constexpr VkImageUsageFlags attachments = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                                  VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
        PlannedResource& planned = plan_.resources[attachment.resource];
        planned.memoryless = declared.transient() && uses.size() == 1 && (planned.image_usage & ~attachments) == 0 &&
                             attachment.store == VK_ATTACHMENT_STORE_OP_DONT_CARE;
    }

    /// An attachment survives a subpass that does not use it only where it is named.
    void add_preserved(const RenderPass& render_pass) {
        preserved_.clear();
        for (size_t i = 0; i + 1 < uses_.size(); ++i) {
            if (uses_[i].attachment != uses_[i + 1].attachment) continue;
            for (uint32_t subpass = uses_[i].subpass + 1; subpass < uses_[i + 1].subpass; ++subpass) {
                preserved_.push_back({subpass, uses_[i].attachment});
            }
        }
        std::sort(preserved_.begin(), preserved_.end());
        size_t next = 0;
        for (uint32_t subpass = 0; subpass < render_pass.subpasses.count; ++subpass) {
            Range& range = plan_.subpasses[render_pass.subpasses.first + subpass].preserved;
            range = {static_cast<uint32_t>(plan_.preserved.size()), 0};
            for (; next < preserved_.size() && preserved_[next].first == subpass; ++next, ++range.count) {
                plan_.preserved.push_back(preserved_[next].second);
            }
        }
    }

    void sort_uses() {
        std::stable_sort(uses_.begin(), uses_.end(), [](const SubpassUse& a, const SubpassUse& b) {
            return a.attachment != b.attachment ? a.attachment < b.attachment : a.subpass < b.subpass;
        });
    }

    /// Reads after writes, writes after reads and writes, each attachment on its own; then one dependency a pair.
    void add_dependencies(RenderPass& render_pass) {
        found_.clear();
        size_t write = SIZE_MAX, first_read = 0;  // the last write of this attachment, and the first read since
        for (size_t i = 0; i < uses_.size(); ++i) {
            const SubpassUse& use = uses_[i];
            if (i == 0 || uses_[i - 1].attachment != use.attachment) {
                write = SIZE_MAX;
                first_read = i;
            }
            const auto depend_on = [&](const SubpassUse& earlier, const Scope& scope) {
                if (earlier.subpass == use.subpass) return;
                found_.push_back(
                    {earlier.subpass, use.subpass, {earlier.scope.stages, write_access(earlier.scope.access)}, scope});
            };
            const bool reads_before = first_read < i;
            if (use.write) {
                for (size_t read = first_read; read < i; ++read)
                    depend_on(uses_[read], use.scope);
                if (!reads_before && write != SIZE_MAX) depend_on(uses_[write], use.scope);
                write = i;
                first_read = i + 1;
                continue;
            }
            if (write != SIZE_MAX) depend_on(uses_[write], use.scope);
            const bool last = i + 1 == uses_.size() || uses_[i + 1].attachment != use.attachment;
            if (!last || !reads_before) continue;
            // The store at the end of the last subpass is a write too, which earlier readers come before.
            const Attachment& attachment = plan_.attachments[render_pass.attachments.first + use.attachment];
            const Scope store = store_scope(resource(attachment.resource).image.format, attachment.store);
            if (store.stages == 0) continue;
            for (size_t read = first_read; read < i; ++read)
                depend_on(uses_[read], store);
        }
        std::stable_sort(found_.begin(), found_.end(), [](const SubpassDependency& a, const SubpassDependency& b) {
            return a.source != b.source ? a.source < b.source : a.destination < b.destination;
        });
        render_pass.dependencies = {static_cast<uint32_t>(plan_.dependencies.size()), 0};
        for (const SubpassDependency& dependency : found_) {
            if (render_pass.dependencies.count > 0) {
                SubpassDependency& last = plan_.dependencies.back();
                if (last.source == dependency.source && last.destination == dependency.destination) {
                    last.source_scope |= dependency.source_scope;
                    last.destination_scope |= dependency.destination_scope;
                    continue;
                }
            }
            plan_.dependencies.push_back(dependency);
            ++render_pass.dependencies.count;
        }
    }

    Compilation& compilation_;
    Plan& plan_;
    std::vector<uint32_t> index_;     // one a resource: its attachment in the current render pass
    std::vector<uint32_t> next_use_;  // one a resource: where in its uses the walk over the groups stands
    std::vector<SubpassUse> uses_;
    std::vector<std::pair<uint32_t, uint32_t>> preserved_;  // subpass, attachment
    std::vector<SubpassDependency> found_;
};

}  // namespace

void plan_render_passes(Compilation& compilation) {
    RenderPassPlanner planner(compilation);
    const Plan& plan = compilation.plan;
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        const uint32_t pass = plan.order[plan.groups[group].passes.first];
        if (compilation.declaration.passes[pass].kind == PassKind::graphics) planner.plan_group(group);
    }
}

}  // namespace splice::graph
