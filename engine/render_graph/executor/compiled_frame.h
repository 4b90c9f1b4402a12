// A plan with the Vulkan objects that it needs.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/executor/histories.h"
#include "engine/render_graph/executor/render_pass_cache.h"
#include "engine/vulkan/memory.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace splice::graph {

class CompiledFrame {
  public:
    CompiledFrame(gpu::Device& device, RenderPassCache& render_passes, const ExecutorOptions& options,
                  const Graph& graph, uint64_t id);

    uint64_t id() const { return id_; }
    const DeclarationKey& key() const { return key_; }
    const Declaration& declaration() const { return declaration_; }
    const Plan& plan() const { return plan_; }
    uint64_t transient_bytes() const { return transient_bytes_; }
    /// Vulkan objects made since the last call.
    uint64_t take_created() { return std::exchange(created_, 0); }

    /// Fills in the imported resources. Throws GraphError where one that the plan uses is not bound or does not match.
    void bind(const Graph& graph, const Bindings& bindings);
    /// Swaps the halves of histories. Where the frame before was another one, what they held is replaced by their
    /// initial contents.
    void begin_histories(const Graph& graph, VkCommandBuffer commands, bool continues) {
        histories_.begin_frame(bound_);
        changed_ = changed_ || !histories_.empty();
        if (!continues) histories_.reset(commands, graph, plan_);
    }
    uint32_t history_side() const { return histories_.side(); }
    const std::vector<BoundResource>& bound() const { return bound_; }
    /// Brings what follows up to date with what is bound now, if that has changed.
    void update();
    /// The plan's barriers, one for one.
    const std::vector<VkImageMemoryBarrier2>& image_barriers() const { return image_barriers_; }
    const std::vector<VkBufferMemoryBarrier2>& buffer_barriers() const { return buffer_barriers_; }
    const std::shared_ptr<const gpu::UniqueRenderPass>& render_pass(uint32_t index) const {
        return render_passes_[index];
    }
    /// One an attachment.
    const VkImageView* views(uint32_t render_pass) const {
        return views_.data() + plan_.render_passes[render_pass].attachments.first;
    }
    /// One an attachment, with the values of this frame where it is cleared.
    const VkClearValue* clear_values(const Graph& graph, uint32_t render_pass);
    VkFramebuffer framebuffer(uint32_t render_pass);

    uint64_t last_used = 0;  ///< executions before this one

  private:
    struct TransientImage {
        gpu::UniqueImage image;
        gpu::UniqueImageView view, depth_view, stencil_view;
    };
    struct Framebuffer {
        gpu::UniqueFramebuffer handle;
        std::vector<VkImageUsageFlags> usages;  // of the attachments it was made for
        uint64_t checked = 0;                   // the bindings that it is known to fit
    };
    void fill_in_barriers();
    void find_moving();
    MemoryRequirement requirement(uint32_t resource, const PlannedResource& planned) const;
    VkImageCreateInfo image_info(uint32_t resource, const PlannedResource& planned) const;
    VkBufferCreateInfo buffer_info(uint32_t resource, const PlannedResource& planned) const;
    void create_image(const Graph& graph, uint32_t resource);
    void create_buffer(const Graph& graph, uint32_t resource);
    void create_history(const Graph& graph, uint32_t previous);
    // Where `memory` is null, they get memory of their own.
    BoundImage make_image(const std::string& name, const VkImageCreateInfo& info, const gpu::Memory* memory,
                          uint64_t offset, gpu::MemoryUse own_use);
    VkBuffer make_buffer(const std::string& name, const VkBufferCreateInfo& info, const gpu::Memory* memory,
                         uint64_t offset);

    gpu::Device* device_;
    uint64_t id_;
    bool lazy_memory_;  // the device has lazily allocated memory
    DeclarationKey key_;
    Declaration declaration_;
    Plan plan_;
    std::vector<gpu::Memory> heaps_, own_memory_;
    std::vector<TransientImage> images_;
    std::vector<gpu::UniqueBuffer> buffers_;
    Histories histories_;
    std::vector<BoundResource> bound_;    // one a resource
    std::vector<uint8_t> needs_binding_;  // one a resource
    std::vector<uint64_t> bound_by_;      // one a resource: the call of bind() that bound it last
    size_t wanted_bindings_ = 0;
    uint64_t bind_calls_ = 0;
    bool changed_ = true;    // a resource is another than the last time
    uint64_t bindings_ = 0;  // how often that was so
    std::vector<VkImageMemoryBarrier2> image_barriers_;
    std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
    std::vector<VkImageView> views_;          // one an attachment of the plan
    std::vector<VkClearValue> clear_values_;  // one an attachment of the plan
    // Of resources that are not always the same: into the plan's barriers and attachments.
    std::vector<uint32_t> moving_image_barriers_, moving_buffer_barriers_, moving_attachments_;
    std::vector<std::shared_ptr<const gpu::UniqueRenderPass>> render_passes_;
    std::vector<Framebuffer> framebuffers_;  // one a render pass
    uint64_t transient_bytes_ = 0;
    uint64_t created_ = 0;
};

}  // namespace splice::graph
