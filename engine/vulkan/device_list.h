// Which devices there are and which of them to use.
#pragma once

#include "engine/vulkan/instance.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace splice::gpu {

struct DeviceInfo {
    uint32_t index = 0;     ///< as `--device INDEX` names it
    std::string name = {};  ///< e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    uint32_t api_version = 0;  ///< VK_MAKE_API_VERSION
    std::string driver;        ///< e.g. "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    std::string unusable;      ///< empty, or why the engine cannot run on it: "Vulkan 1.1, needs 1.3"
    VkPhysicalDevice handle = VK_NULL_HANDLE;

    bool is_cpu() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
};

/// All devices in the loader's order. Empty when no driver is installed.
std::vector<DeviceInfo> list_devices(const Instance& instance);

struct DeviceChoice {
    enum class Kind {
        automatic,  ///< a discrete GPU, else an integrated or virtual one, else a software rasteriser
        cpu,        ///< a software rasteriser
        index,
    };
    Kind kind = Kind::automatic;
    uint32_t index = 0;
};

/// "auto", "cpu" or an index. Throws UsageError for anything else.
DeviceChoice parse_device_choice(std::string_view text);

/// The device that the choice means. Throws DeviceError when there is none or it is unusable, saying how to install
/// lavapipe (`apt install mesa-vulkan-drivers`); ties go to the lowest index.
DeviceInfo choose_device(const std::vector<DeviceInfo>& devices, const DeviceChoice& choice);

}  // namespace splice::gpu
