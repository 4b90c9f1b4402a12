// Gives the passes of a declared family something to draw on a device: every pass reads what it declared to read.
#pragma once

#include "engine/bench/graph/pass_shaders.h"
#include "engine/render_graph/executor/pass_context.h"
#include "engine/render_graph/executor/pass_pipelines.h"
#include "engine/render_graph/graph.h"

#include <cstdint>
#include <deque>
#include <vector>

namespace splice::bench {

/// Serves one executor.
class Painter {
  public:
    /// `objects`: draws in a pass that writes depth; the others have one.
    Painter(gpu::Device& device, const PassShaders& shaders, uint32_t objects)
        : device_(&device), shaders_(&shaders), objects_(objects), pool_(device) {}
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    /// FamilyOptions::paint. May be called anew for each frame as long as the structure stays the same.
    void paint(graph::Graph& graph, graph::Pass& pass);

  private:
    struct Read {
        graph::ImageHandle image;
        VkImageLayout layout;
    };
    struct PaintedPass {
        PassShape shape;
        std::vector<Read> sampled, inputs;
        std::vector<Rectangle> draws;
        graph::PassPipelines pipelines;
        uint64_t plan_id = 0;  // that the set was written for
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    PaintedPass study(const graph::Graph& graph, uint32_t pass) const;
    void record(const graph::PassContext& context, uint32_t pass);
    void write_set(const graph::PassContext& context, PaintedPass& pass);

    gpu::Device* device_;
    const PassShaders* shaders_;
    uint32_t objects_;
    gpu::DescriptorPool pool_;
    std::deque<PaintedPass> passes_;  // by index in the graph
};

}  // namespace splice::bench
