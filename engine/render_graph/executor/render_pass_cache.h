// VkRenderPass objects by what they are made of; size and clear values are no part of it.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace splice::graph {

class RenderPassCache {
  public:
    explicit RenderPassCache(gpu::Device& device) : device_(&device) {}
    std::shared_ptr<const gpu::UniqueRenderPass> get(const Declaration& declaration, const Plan& plan,
                                                     const RenderPass& render_pass);
    uint64_t created() const { return render_passes_.size(); }

  private:
    gpu::Device* device_;
    std::map<std::vector<uint32_t>, std::shared_ptr<const gpu::UniqueRenderPass>> render_passes_;
};

}  // namespace splice::graph
