// The graphics pipelines of a drawing routine, by where in a render pass it is recorded.
#pragma once

#include "engine/render_graph/executor/pass_context.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/pipeline.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>

namespace splice::graph {

/// One pipeline for each subpass that the routine is recorded in. Serves any number of
/// executors, one after the other too: render passes are told apart by their owners, as handles may come again.
class PassPipelines {
  public:
    /// `options` is called when the render pass or the subpass is new; render_pass, subpass and samples are filled in
    /// here.
    VkPipeline get(const gpu::Device& device, const PassContext& context,
                   const std::function<gpu::GraphicsPipelineOptions()>& options);

  private:
    struct Place {
        std::weak_ptr<const gpu::UniqueRenderPass> render_pass;
        uint32_t subpass;
        friend bool operator<(const Place& a, const Place& b) {
            if (a.render_pass.owner_before(b.render_pass)) return true;
            return !b.render_pass.owner_before(a.render_pass) && a.subpass < b.subpass;
        }
    };
    static bool same(const Place& place, const PassContext& context) {
        return place.subpass == context.subpass && !place.render_pass.owner_before(*context.render_pass_owner) &&
               !context.render_pass_owner->owner_before(place.render_pass);
    }
    std::map<Place, gpu::GraphicsPipeline> pipelines_;
};

}  // namespace splice::graph
