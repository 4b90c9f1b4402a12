// A declared graph, ready to run on a device: with its executor and the real resources behind what it imports.
#pragma once

#include "engine/render_graph/executor/executor.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace splice::bench {

class DeviceGraph {
  public:
    /// `declare` fills an empty graph, always with the same structure, and serves this object alone.
    DeviceGraph(gpu::Device& device, std::function<void(graph::Graph&)> declare, const graph::ExecutorOptions& options);

    void declare_anew() {
        graph_.clear();
        declare_(graph_);
    }
    void prepare() { executor_.prepare(graph_); }
    void record(VkCommandBuffer commands) { executor_.execute(graph_, bindings_, commands); }
    const graph::Graph& graph() const { return graph_; }
    const graph::Executor& executor() const { return executor_; }
    /// Of everything imported, one after the other, after all submitted work.
    std::vector<std::byte> results();

  private:
    void create_imported(uint32_t resource);

    gpu::Device* device_;
    std::function<void(graph::Graph&)> declare_;
    graph::Graph graph_;
    graph::Executor executor_;
    graph::Bindings bindings_;
    std::vector<gpu::Image> images_;
    std::vector<gpu::Buffer> buffers_;
};

}  // namespace splice::bench
