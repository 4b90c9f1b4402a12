#include "engine/bench/graph/painter.h"

#include <utility>

namespace splice::bench {

void Painter::paint(graph::Graph& graph, graph::Pass& pass) {
    const uint32_t index = pass.index();
    if (index == passes_.size()) passes_.push_back(study(graph, index));
    pass.record([this, index](const graph::PassContext& context) { record(context, index); });
}

Painter::PaintedPass Painter::study(const graph::Graph& graph, uint32_t pass) const {
    PaintedPass painted;
    for (const graph::Access& access : graph.accesses(pass)) {
        const VkFormat format = graph.declaration().resources[access.resource].image.format;
        const Read read{graph.image(access.resource), graph::layout_of(access.kind, format)};
        switch (access.kind) {
            case graph::AccessKind::sampled:
                if (painted.sampled.size() < kMaxSampled) painted.sampled.push_back(read);
                break;
            case graph::AccessKind::input_attachment:
                painted.inputs.push_back(read);
                break;
            case graph::AccessKind::colour_attachment:
                ++painted.shape.outputs;
                painted.shape.blended.push_back(access.contents == graph::ContentsKind::keep);
                break;
            default:
                painted.shape.depth_written = true;
        }
    }
    painted.shape.sampled = static_cast<uint32_t>(painted.sampled.size());
    painted.shape.inputs = static_cast<uint32_t>(painted.inputs.size());
    painted.draws = rectangles(pass, painted.shape.depth_written ? objects_ : 1);
    return painted;
}

void Painter::write_set(const graph::PassContext& context, PaintedPass& pass) {
    pass.set = pool_.allocate(shaders_->set_layout(pass.shape.inputs));
    pass.plan_id = context.plan_id;
    const auto images = [&](const std::vector<Read>& reads) {
        std::vector<ReadImage> found;
        for (const Read& read : reads)
            found.push_back({context.depth_view(read.image), read.layout});
        return found;
    };
    shaders_->write_set(pass.set, images(pass.sampled), images(pass.inputs));
}

void Painter::record(const graph::PassContext& context, uint32_t index) {
    PaintedPass& pass = passes_[index];
    if (pass.plan_id != context.plan_id) write_set(context, pass);
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pass.pipelines.get(*device_, context, [&] { return shaders_->pipeline_options(pass.shape); }));
    const VkPipelineLayout layout = shaders_->layout(pass.shape.inputs);
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &pass.set, 0, nullptr);
    draw_rectangles(context.commands, layout, pass.draws);
}

}  // namespace splice::bench
