// A plan with the Vulkan objects that it needs.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/executor/render_pass_cache.h"
#include "engine/vulkan/memory.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace splice::graph {

class CompiledFrame {
  public:
    CompiledFrame(gpu::Device& device, RenderPassCache& render_passes, const ExecutorOptions& options,
                  const Graph& graph, uint64_t id);

    uint64_t id() const { return id_; }
    const Declaration& declaration() const { return declaration_; }
    const Plan& plan() const { return plan_; }
    uint64_t transient_bytes() const { return transient_bytes_; }
    /// Vulkan objects made since the last call.
    uint64_t take_created() { return std::exchange(created_, 0); }

    /// Fills in the imported resources. Throws GraphError where one that the plan uses is not bound or does not match.
    void bind(const Graph& graph, const Bindings& bindings);
    const std::vector<BoundResource>& bound() const { return bound_; }
    VkRenderPass render_pass(uint32_t index) const { return render_passes_[index]; }
    /// For the resources bound last.
    VkFramebuffer framebuffer(uint32_t render_pass);

    uint64_t last_used = 0;  ///< executions before this one

  private:
    struct TransientImage {
        gpu::Memory own_memory;  // unless placed in a heap
        gpu::UniqueImage image;
        gpu::UniqueImageView view, depth_view, stencil_view;
    };
    struct Framebuffer {
        gpu::UniqueFramebuffer handle;
        std::vector<VkImageUsageFlags> usages;  // of the attachments it was made for
    };
    MemoryRequirement requirement(uint32_t resource, const PlannedResource& planned) const;
    VkImageCreateInfo image_info(uint32_t resource, const PlannedResource& planned) const;
    VkBufferCreateInfo buffer_info(uint32_t resource, const PlannedResource& planned) const;
    void create_image(const Graph& graph, uint32_t resource);
    void create_buffer(const Graph& graph, uint32_t resource);

    gpu::Device* device_;
    uint64_t id_;
    bool lazy_memory_;  // the device has lazily allocated memory
    Declaration declaration_;
    Plan plan_;
    std::vector<gpu::Memory> heaps_;
    std::vector<TransientImage> images_;
    std::vector<gpu::UniqueBuffer> buffers_;
    std::vector<BoundResource> bound_;    // one a resource
    std::vector<uint8_t> needs_binding_;  // one a resource
    std::vector<VkRenderPass> render_passes_;
    std::vector<Framebuffer> framebuffers_;  // one a render pass
    uint64_t transient_bytes_ = 0;
    uint64_t created_ = 0;
};

}  // namespace splice::graph
