#include "engine/vulkan/device.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <optional>
#include <vector>

// Loaders unload the software driver and the validation layer before the process ends, so LeakSanitizer can name no
// module for what those keep, and no suppression fits. Programs with a device watch their Vulkan handles by validation.
#ifdef __SANITIZE_ADDRESS__
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() {
    return "detect_leaks=0";
}  // NOLINT(bugprone-reserved-identifier)
#endif

namespace splice::gpu {
namespace {

struct QueueFamily {
    uint32_t index = 0;
    bool timestamps = false;
};

QueueFamily find_queue_family(VkPhysicalDevice physical) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & both) == both) return {i, families[i].timestampValidBits != 0};
    }
    throw DeviceError("the Vulkan device has no queue for both graphics and compute");
}

/// Those that cannot show images on the surface are marked as unusable.
std::vector<DeviceInfo> devices_for(const Instance& instance, VkSurfaceKHR surface) {
    std::vector<DeviceInfo> devices = list_devices(instance);
    if (surface == VK_NULL_HANDLE) return devices;
    for (DeviceInfo& device : devices) {
        if (!device.unusable.empty()) continue;
        VkBool32 presents = VK_FALSE;
        check(vkGetPhysicalDeviceSurfaceSupportKHR(device.handle, find_queue_family(device.handle).index, surface,
                                                   &presents),
              "asking whether a device can draw in the window");
        if (presents == VK_FALSE) device.unusable = "cannot draw in windows of this display";
    }
    return devices;
}

/// The chain of feature structs, linked once; not copyable because the links point inside.
struct FeatureChain {
    VkPhysicalDeviceFeatures2 core{};
    VkPhysicalDeviceVulkan11Features v11{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};

    FeatureChain() {
        core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
        v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
        v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
        core.pNext = &v11;
        v11.pNext = &v12;
        v12.pNext = &v13;
    }
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;
};

}  // namespace

Device::Device(const Instance& instance, const DeviceOptions& options)
    : instance_(&instance),
      options_(options),
      info_(choose_device(devices_for(instance, options.surface), options.choice)) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(info_.handle, &properties);
    limits_ = properties.limits;
    const QueueFamily family = find_queue_family(info_.handle);
    queue_family_ = family.index;
    features_.timestamps = family.timestamps && limits_.timestampPeriod > 0;
    create_device();
    // From here on the destructor does not run if a constructor throws, so what may fail comes after owning handles
    // only.
    try {
        vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
        memory_ = std::make_unique<MemoryAllocator>(info_.handle, device_);

        VkPipelineCacheCreateInfo cache{};
        cache.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
        VkPipelineCache cache_handle = VK_NULL_HANDLE;
        check(vkCreatePipelineCache(device_, &cache, nullptr, &cache_handle), "creating the pipeline cache");
        pipeline_cache_ = UniquePipelineCache(device_, cache_handle);

        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        pool.queueFamilyIndex = queue_family_;
        VkCommandPool pool_handle = VK_NULL_HANDLE;
        check(vkCreateCommandPool(device_, &pool, nullptr, &pool_handle), "creating the command pool");
        command_pool_ = UniqueCommandPool(device_, pool_handle);

        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_handle;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device_, &allocate, &commands_), "allocating the command buffer");

        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkFence fence_handle = VK_NULL_HANDLE;
        check(vkCreateFence(device_, &fence, nullptr, &fence_handle), "creating a fence");
        fence_ = UniqueFence(device_, fence_handle);
    } catch (...) {
        command_pool_.reset();
        pipeline_cache_.reset();
        memory_.reset();
        vkDestroyDevice(device_, nullptr);
        throw;
    }
    if (instance.debug_utils()) {
        set_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
        begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
            vkGetDeviceProcAddr(device_, "vkCmdBeginDebugUtilsLabelEXT"));
        end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
            vkGetDeviceProcAddr(device_, "vkCmdEndDebugUtilsLabelEXT"));
    }
}

void Device::create_device() {
    FeatureChain have;
    vkGetPhysicalDeviceFeatures2(info_.handle, &have.core);
    FeatureChain want;
    // Mandatory in Vulkan 1.3, but to be switched on.
    want.v12.imagelessFramebuffer = VK_TRUE;
    want.v13.synchronization2 = VK_TRUE;
    want.v13.maintenance4 = VK_TRUE;

    const auto optional = [](VkBool32 available, VkBool32& enabled) {
        enabled = available;
        return available == VK_TRUE;
    };
    const VkPhysicalDeviceFeatures& core = have.core.features;
    VkPhysicalDeviceFeatures& on = want.core.features;
    features_.fill_mode_non_solid = optional(core.fillModeNonSolid, on.fillModeNonSolid);
    features_.large_points = optional(core.largePoints, on.largePoints);
    features_.wide_lines = optional(core.wideLines, on.wideLines);
    features_.independent_blend = optional(core.independentBlend, on.independentBlend);
    features_.depth_clamp = optional(core.depthClamp, on.depthClamp);
    features_.sampler_anisotropy = optional(core.samplerAnisotropy, on.samplerAnisotropy);
    features_.multi_draw_indirect = optional(core.multiDrawIndirect, on.multiDrawIndirect);
    features_.draw_indirect_first_instance = optional(core.drawIndirectFirstInstance, on.drawIndirectFirstInstance);
    features_.fragment_stores_and_atomics = optional(core.fragmentStoresAndAtomics, on.fragmentStoresAndAtomics);
    features_.vertex_stores_and_atomics =
        optional(core.vertexPipelineStoresAndAtomics, on.vertexPipelineStoresAndAtomics);
    features_.pipeline_statistics = optional(core.pipelineStatisticsQuery, on.pipelineStatisticsQuery);
    features_.shader_int64 = optional(core.shaderInt64, on.shaderInt64);
    features_.draw_indirect_count = optional(have.v12.drawIndirectCount, want.v12.drawIndirectCount);
    features_.buffer_int64_atomics = optional(have.v12.shaderBufferInt64Atomics, want.v12.shaderBufferInt64Atomics);
    features_.shader_draw_parameters = optional(have.v11.shaderDrawParameters, want.v11.shaderDrawParameters);

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &want.core;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    create.enabledExtensionCount = options_.surface != VK_NULL_HANDLE ? 1 : 0;
    create.ppEnabledExtensionNames = &swapchain;
    check(vkCreateDevice(info_.handle, &create, nullptr, &device_), "opening the Vulkan device '" + info_.name + "'");
}

Device::~Device() {
    vkDeviceWaitIdle(device_);
    fence_.reset();
    command_pool_.reset();
    pipeline_cache_.reset();
    memory_.reset();
    vkDestroyDevice(device_, nullptr);
}

VkFormat Device::first_supported(std::initializer_list<VkFormat> formats, VkFormatFeatureFlags features) const {
    for (const VkFormat format : formats) {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(info_.handle, format, &properties);
        if ((properties.optimalTilingFeatures & features) == features) return format;
    }
    return VK_FORMAT_UNDEFINED;
}

VkFormat Device::depth_stencil_format() const {
    const VkFormat format = first_supported({VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT},
                                            VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
    if (format == VK_FORMAT_UNDEFINED) throw DeviceError("'" + info_.name + "' has no depth-stencil format");
    return format;
}

void Device::submit_and_wait(const std::function<void(VkCommandBuffer)>& record, const SubmitSemaphores& semaphores) {
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "beginning a command buffer");
    try {
        record(commands_);
    } catch (...) {
        vkResetCommandBuffer(commands_, 0);
        throw;
    }
    check(vkEndCommandBuffer(commands_), "recording a command buffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    submit.waitSemaphoreCount = semaphores.wait != VK_NULL_HANDLE ? 1 : 0;
    submit.pWaitSemaphores = &semaphores.wait;
    submit.pWaitDstStageMask = &semaphores.wait_stages;
    submit.signalSemaphoreCount = semaphores.signal != VK_NULL_HANDLE ? 1 : 0;
    submit.pSignalSemaphores = &semaphores.signal;
    const VkFence fence = fence_.get();
    check(vkQueueSubmit(queue_, 1, &submit, fence), "submitting commands");
    check(vkWaitForFences(device_, 1, &fence, VK_TRUE, UINT64_MAX), "waiting for the device");
    check(vkResetFences(device_, 1, &fence), "resetting a fence");
}

const std::vector<uint32_t>* Device::replacement_of(const std::string& shader) const {
    const auto found = shaders_.find(shader);
    return found == shaders_.end() ? nullptr : &found->second;
}

void Device::wait_idle() {
    check(vkDeviceWaitIdle(device_), "waiting for the device");
}

void Device::set_object_name(VkObjectType type, uint64_t handle, const std::string& name) const {
    if (!set_name_ || name.empty()) return;
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    check(set_name_(device_, &info), "naming " + name);
}

void Device::begin_label(VkCommandBuffer commands, const std::string& name) const {
    if (!begin_label_) return;
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = name.c_str();
    begin_label_(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) const {
    if (end_label_) end_label_(commands);
}

}  // namespace splice::gpu
