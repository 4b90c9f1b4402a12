// What all passes of a frame share: settings, the draw list, and set 0 with the frame's uniforms and lights.
#pragma once

#include "engine/passes/shader_types.h"
#include "engine/scene/camera.h"
#include "engine/scene/draw_list.h"
#include "engine/scene/kernel.h"
#include "engine/scene/scene.h"
#include "engine/scene/shading.h"
#include "engine/scene/view.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/pipeline.h"

#include <compare>
#include <cstdint>
#include <map>

namespace splice {

struct FrameSettings {
    std::uint32_t width = 512, height = 512;  // samples: pixels of the picture times antialias
    std::uint32_t antialias = 1;              // samples along each side of a pixel
    Camera camera;
    View view = View::kShaded;
    double epsilon_scale = 1;
    bool prefilter = true;
    Kernel kernel = {};
    Shading shading = Shading::kSurfel;
    bool cull_groups = true;     // see CaptureSettings
    std::uint32_t lighting = 0;  // lighting_flags() of the lights that FrameData is updated with
};

/// What these lights need, LightingFlags: pipelines are specialised for it.
std::uint32_t lighting_flags(const Lighting& lighting);

/// Whether normals and albedos are blended and lit afterwards: only where the view shows light.
bool is_deferred(const FrameSettings& settings);

/// Views of numbers fill a float target, the others an 8-bit one.
bool is_numeric(View view);

/// Stages of the two descriptor sets: set 0 is the frame's for every pass.
gpu::DescriptorSetLayout frame_set_layout(const gpu::Device& device);

/// The buffers behind set 0, written anew for each frame.
class FrameData {
  public:
    explicit FrameData(gpu::Device& device);
    /// No submitted work may still read the frame before.
    void update(const FrameSettings& settings, const Lighting& lighting, const Background& background = {});
    VkDescriptorSet set() const { return set_; }
    const gpu::DescriptorSetLayout& layout() const { return layout_; }

  private:
    void reserve_lights(std::size_t count);

    gpu::Device& device_;
    gpu::DescriptorSetLayout layout_;
    gpu::DescriptorPool pool_;
    gpu::Buffer uniforms_, lights_;
    gpu::UniqueBufferView light_view_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// What pipelines are specialised for: the constants of frame.glsl and splat.glsl, and the attachments.
struct FrameVariant {
    std::uint32_t view;
    std::uint32_t orthographic;
    bool deferred;
    std::uint32_t lighting;
    Kernel kernel;
    auto operator<=>(const FrameVariant&) const = default;
};
FrameVariant frame_variant(const FrameSettings& settings);
std::map<std::uint32_t, std::uint32_t> frame_constants(const FrameSettings& settings);

InstanceConstants instance_constants(const InstanceDraws& draws, double epsilon_scale);

}  // namespace splice
