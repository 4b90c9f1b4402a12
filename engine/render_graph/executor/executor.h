// Runs compiled graphs on a device. Everything a plan needs (render passes, framebuffers, transient images and buffers)
// is made when a declaration is first seen and kept, so a steady frame creates nothing.
//
//   graph::Executor executor(device);
//   graph::Bindings bindings;
//   bindings.bind(pixels, readback_buffer);
//   device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(frame, bindings, commands); });
//   for (const graph::PassTiming& timing : executor.timings()) ...
//
// In a record function:
//   void draw(const graph::PassContext& context) {
//       VkPipeline pipeline = pipelines.get(context, [&] {           // graph::PassPipelines pipelines;
//           gpu::GraphicsPipelineOptions options = ...;              // render pass and subpass are filled in
//           return options; });
//       vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
//   }
// Input attachments: DescriptorWriter(set).input_attachment(0, context.view(colour),
// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL); depth: context.depth_view(depth),
// VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL. Storage images: GENERAL.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/executor/pass_context.h"
#include "engine/render_graph/executor/pass_pipelines.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "engine/vulkan/pipeline_statistics.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace splice::graph {

/// The real resources behind the imported ones of a graph.
class Bindings {
  public:
    void bind(ImageHandle handle, const gpu::Image& image);
    /// E.g. of a swapchain. `description` as the graph declares it.
    void bind(ImageHandle handle, const BoundImage& image, const ImageDescription& description);
    void bind(BufferHandle handle, const gpu::Buffer& buffer);

    struct Entry {
        uint32_t resource = 0;
        BoundResource bound;
        ImageDescription image;    ///< of a bound image
        BufferDescription buffer;  ///< of a bound buffer
    };
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    std::vector<Entry> entries_;
};

struct ExecutorOptions {
    uint32_t frames_in_flight = 1;
    bool timestamps = true;            ///< where the device has them
    bool pipeline_statistics = false;  ///< of graphics passes, where the device has them
    /// Compiled plans kept, with their transient resources; the one unused for longest goes first, once the device is
    /// idle. At least as many as one command buffer executes graphs.
    uint32_t max_plans = 8;
    bool cull = true, merge = true, alias = true, batch_barriers = true;  ///< as in CompileOptions
    std::optional<uint64_t> random_order = {};                            ///< as in CompileOptions
};

struct PassTiming {
    std::string name;
    double gpu_ms = 0;  ///< from the end of the pass recorded before it to its own end; 0 without timestamps
    std::optional<gpu::PipelineCounts> counts = {};  ///< of graphics passes
};

struct ExecutorStatistics {
    uint64_t compilations = 0;     ///< plans made, since the start
    uint64_t objects_created = 0;  ///< Vulkan objects, since the start: constant while frames are steady
    // Of the last execution:
    uint32_t passes = 0, render_passes = 0, barrier_commands = 0, image_barriers = 0, buffer_barriers = 0;
    uint64_t transient_bytes = 0;
};

class Executor {
  public:
    /// The device must outlive the executor.
    explicit Executor(gpu::Device& device, const ExecutorOptions& options = {});
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Compiles the graph and makes its Vulkan objects unless that was done before: execute() will not have to. Throws
    /// GraphError and DeviceError.
    void prepare(const Graph& graph);

    /// Records the whole frame, compiling the graph if its structure is new. frame_slot < frames_in_flight: the work
    /// submitted for this slot before has finished. Throws GraphError (an imported resource that is not bound, or does
    /// not match its declaration) and DeviceError.
    void execute(const Graph& graph, const Bindings& bindings, VkCommandBuffer commands, uint32_t frame_slot = 0);

    /// The plan of the last execution.
    const Plan& plan() const;
    /// Times and counts of the passes of the slot's last execution, in recorded order, once it has finished; empty
    /// without either. Where a device works tile by tile, subpasses of one render pass overlap: only their sum is
    /// exact.
    std::vector<PassTiming> timings(uint32_t frame_slot = 0) const;
    const ExecutorStatistics& statistics() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace splice::graph
