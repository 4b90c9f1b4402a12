// The logical device: one queue that does graphics, compute and transfer, the features in use, memory, and submission.
// Nothing here is thread-safe: one thread records and submits.
#pragma once

#include "engine/vulkan/device_list.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/instance.h"
#include "engine/vulkan/memory.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace splice::gpu {

struct DeviceOptions {
    DeviceChoice choice = {};
    /// Upload through staging buffers even where device memory is mapped, so that a software rasteriser can test that
    /// path.
    bool force_staging = false;
    /// Where swapchains of the device will show their images; only devices that can are considered.
    VkSurfaceKHR surface = VK_NULL_HANDLE;
};

/// Semaphores around a submission; null: none.
struct SubmitSemaphores {
    VkSemaphore wait = VK_NULL_HANDLE;
    VkPipelineStageFlags wait_stages = 0;  ///< that wait
    VkSemaphore signal = VK_NULL_HANDLE;
};

/// Optional abilities; a feature that the device lacks is off and the caller chooses another way.
struct DeviceFeatures {
    bool fill_mode_non_solid = false;  ///< VK_POLYGON_MODE_LINE
    bool large_points = false;         ///< point sizes other than 1, up to limits().pointSizeRange[1]
    bool wide_lines = false;
    bool independent_blend = false;
    bool depth_clamp = false;
    bool sampler_anisotropy = false;
    bool multi_draw_indirect = false;
    bool draw_indirect_first_instance = false;
    bool draw_indirect_count = false;
    bool fragment_stores_and_atomics = false;
    bool vertex_stores_and_atomics = false;
    bool shader_int64 = false;
    bool buffer_int64_atomics = false;
    bool shader_draw_parameters = false;
    bool timestamps = false;  ///< on the queue in use
    bool pipeline_statistics = false;
};

class Device {
  public:
    /// The instance must outlive the device. Throws DeviceError.
    explicit Device(const Instance& instance, const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return info_.handle; }
    VkQueue queue() const { return queue_; }
    uint32_t queue_family() const { return queue_family_; }
    const Instance& instance() const { return *instance_; }
    const DeviceInfo& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return limits_; }
    const DeviceFeatures& features() const { return features_; }
    bool force_staging() const { return options_.force_staging; }
    MemoryAllocator& memory() { return *memory_; }
    /// SPIR-V that shader modules made from now on take in place of what they are given, by name ("triangle.vert").
    void replace_shaders(std::map<std::string, std::vector<uint32_t>> shaders) { shaders_ = std::move(shaders); }
    /// The replacement of a shader; null: there is none.
    const std::vector<uint32_t>* replacement_of(const std::string& shader) const;
    /// Shared by all pipelines of the device, so that equal shaders are translated once a process.
    VkPipelineCache pipeline_cache() const { return pipeline_cache_.get(); }

    /// The first of `formats` whose optimal tiling has all of `features`; VK_FORMAT_UNDEFINED if none.
    VkFormat first_supported(std::initializer_list<VkFormat> formats, VkFormatFeatureFlags features) const;
    /// D32_SFLOAT_S8_UINT, else D24_UNORM_S8_UINT: one of them is mandatory.
    VkFormat depth_stencil_format() const;

    /// Records commands, submits them and waits until they are done. Never from within `record`. What `record` throws
    /// is passed on and nothing is submitted. Throws DeviceError (a lost device included).
    void submit_and_wait(const std::function<void(VkCommandBuffer)>& record, const SubmitSemaphores& semaphores = {});
    void wait_idle();

    /// Debug names and labels; no-ops unless the instance has VK_EXT_debug_utils. Handles: any non-dispatchable one.
    template <typename T>
    void set_name(VkObjectType type, T handle, const std::string& name) const {
        set_object_name(type, reinterpret_cast<uint64_t>(handle), name);
    }
    void begin_label(VkCommandBuffer commands, const std::string& name) const;
    void end_label(VkCommandBuffer commands) const;

  private:
    void set_object_name(VkObjectType type, uint64_t handle, const std::string& name) const;
    void create_device();

    const Instance* instance_;
    DeviceOptions options_;
    DeviceInfo info_;
    VkPhysicalDeviceLimits limits_{};
    DeviceFeatures features_;
    uint32_t queue_family_ = 0;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::unique_ptr<MemoryAllocator> memory_;
    UniquePipelineCache pipeline_cache_;
    std::map<std::string, std::vector<uint32_t>> shaders_;
    UniqueCommandPool command_pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    UniqueFence fence_;
    PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
};

}  // namespace splice::gpu
