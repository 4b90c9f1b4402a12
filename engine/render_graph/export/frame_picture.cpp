#include "engine/render_graph/export/frame_picture.h"

#include "engine/render_graph/compile.h"

#include <vulkan/vulkan.hpp>
#include <vulkan/vulkan_to_string.hpp>

#include <algorithm>
#include <cstddef>

namespace splice::graph {
namespace {

const char* residence_of(const ResourceDeclaration& resource) {
    if (resource.imported) return "imported";
    return resource.history == HistoryRole::none ? "transient" : "history";
}

const char* contents_of(const Access& access) {
    if (!is_write(access.kind)) return "";
    switch (access.contents) {
        case ContentsKind::keep:
            return "keep";
        case ContentsKind::discard:
            return "discard";
        case ContentsKind::clear:
            return "clear";
    }
    return "";
}

std::string text_of(const Scope& scope) {
    return vk::to_string(vk::PipelineStageFlags(scope.stages)) + " " + vk::to_string(vk::AccessFlags(scope.access));
}

std::string text_of(VkImageLayout layout) {
    return vk::to_string(static_cast<vk::ImageLayout>(layout));
}

class Painter {
  public:
    Painter(const Graph& graph, const Plan* plan) : graph_(graph), plan_(plan) {}

    FramePicture run() {
        picture_.compiled = plan_ != nullptr;
        add_resources();
        add_passes();
        group_of_.assign(picture_.passes.size(), none);
        if (plan_) add_plan();
        add_edges();
        return std::move(picture_);
    }

  private:
    const Declaration& declaration() const { return graph_.declaration(); }

    void add_resources() {
        for (uint32_t resource = 0; resource < declaration().resources.size(); ++resource) {
            const ResourceDeclaration& declared = declaration().resources[resource];
            FramePicture::Resource& added = picture_.resources.emplace_back();
            added.name = graph_.resource_name(resource);
            added.residence = residence_of(declared);
            added.is_image = declared.kind == ResourceKind::image;
            added.image = declared.image;
            added.bytes = declared.buffer.size;
            if (added.is_image) added.format = vk::to_string(static_cast<vk::Format>(declared.image.format));
            if (plan_) added.planned = plan_->resources[resource];
        }
    }

    void add_passes() {
        for (uint32_t pass = 0; pass < declaration().passes.size(); ++pass) {
            FramePicture::Pass& added = picture_.passes.emplace_back();
            added.name = graph_.pass_name(pass);
            added.kind = declaration().passes[pass].kind;
            added.side_effect = declaration().passes[pass].side_effect;
            for (const Access& access : graph_.accesses(pass)) {
                added.uses.push_back({access.resource, access.version, describe(access.kind), contents_of(access)});
            }
        }
    }

    std::vector<FramePicture::Barrier> barriers_of(const BarrierBatch& batch) const {
        std::vector<FramePicture::Barrier> barriers;
        for (const ImageBarrier& barrier : slice(plan_->image_barriers, batch.images)) {
            barriers.push_back({barrier.resource, text_of(barrier.source), text_of(barrier.destination),
                                text_of(barrier.old_layout), text_of(barrier.new_layout)});
        }
        for (const BufferBarrier& barrier : slice(plan_->buffer_barriers, batch.buffers)) {
            barriers.push_back({barrier.resource, text_of(barrier.source), text_of(barrier.destination), "", ""});
        }
        return barriers;
    }

    void add_plan() {
        for (const Group& group : plan_->groups) {
            FramePicture::Group& added = picture_.groups.emplace_back();
            for (const uint32_t pass : slice(plan_->order, group.passes)) {
                group_of_[pass] = static_cast<uint32_t>(picture_.groups.size() - 1);
                added.passes.push_back(pass);
            }
            if (group.render_pass != none) {
                const RenderPass& render_pass = plan_->render_passes[group.render_pass];
                added.width = render_pass.width;
                added.height = render_pass.height;
                added.attachments = render_pass.attachments.count;
            }
            added.barriers = barriers_of(group.barriers);
        }
        picture_.final_barriers = barriers_of(plan_->final_barriers);
        picture_.heaps = plan_->heaps;
        for (const CulledPass& culled : plan_->culled)
            picture_.passes[culled.pass].culled = explain(graph_, culled);
        for (const Unmerged& unmerged : plan_->unmerged)
            picture_.unmerged.push_back(explain(graph_, unmerged));
    }

    void add_edges() {
        std::vector<uint32_t> maker(declaration().resources.size(), none);
        for (uint32_t pass = 0; pass < declaration().passes.size(); ++pass) {
            const size_t first = picture_.edges.size();  // a pass may read one thing in two ways
            for (const Access& access : graph_.accesses(pass)) {
                const uint32_t from = maker[access.resource];
                const bool reads = !is_write(access.kind) || access.contents == ContentsKind::keep;
                const auto same = [&](const FramePicture::Edge& edge) {
                    return edge.from == from && edge.to == pass && edge.resource == access.resource;
                };
                const auto here = picture_.edges.begin() + static_cast<std::ptrdiff_t>(first);
                if (reads && from != none && std::none_of(here, picture_.edges.end(), same)) {
                    const bool inside = group_of_[from] != none && group_of_[from] == group_of_[pass];
                    picture_.edges.push_back({from, pass, access.resource, inside});
                }
                if (is_write(access.kind)) maker[access.resource] = pass;
            }
        }
    }

    const Graph& graph_;
    const Plan* plan_;
    FramePicture picture_;
    std::vector<uint32_t> group_of_;  // one a pass
};

}  // namespace

FramePicture picture_of(const Graph& graph, const Plan* plan) {
    return Painter(graph, plan).run();
}

std::vector<std::string> group_label(const FramePicture& picture, uint32_t index) {
    const FramePicture::Group& group = picture.groups[index];
    std::string label = std::to_string(index);
    if (group.width != 0) {
        label += ": render pass " + std::to_string(group.width) + " x " + std::to_string(group.height) + ", " +
                 std::to_string(group.attachments) + " attachments";
    }
    const size_t barriers = group.barriers.size();
    return {label, std::to_string(barriers) + (barriers == 1 ? " barrier" : " barriers") + " before"};
}

}  // namespace splice::graph
