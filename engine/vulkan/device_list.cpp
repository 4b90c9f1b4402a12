#include "engine/vulkan/device_list.h"

#include "engine/vulkan/handle.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace splice::gpu {
namespace {

constexpr const char* kInstallHint = "; `apt install mesa-vulkan-drivers` provides a software device (lavapipe)";

std::string version_text(uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version));
}

bool has_graphics_queue(VkPhysicalDevice device) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    return std::any_of(families.begin(), families.end(),
                       [](const VkQueueFamilyProperties& family) { return (family.queueFlags & both) == both; });
}

/// Lower is better for DeviceChoice::automatic.
int rank(const DeviceInfo& device) {
    switch (device.type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 3;
        default:
            return 4;
    }
}

}  // namespace

std::vector<DeviceInfo> list_devices(const Instance& instance) {
    uint32_t count = 0;
    const VkResult listed = vkEnumeratePhysicalDevices(instance.handle(), &count, nullptr);
    if (listed == VK_ERROR_INITIALIZATION_FAILED) return {};  // what the loader says when every driver failed
    check(listed, "listing the Vulkan devices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance.handle(), &count, handles.data()), "listing the Vulkan devices");
    std::vector<DeviceInfo> devices;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties basic;
        vkGetPhysicalDeviceProperties(handles[i], &basic);
        DeviceInfo info;
        info.index = i;
        info.name = basic.deviceName;
        info.type = basic.deviceType;
        info.api_version = basic.apiVersion;
        info.handle = handles[i];
        if (basic.apiVersion >= VK_API_VERSION_1_2) {
            VkPhysicalDeviceDriverProperties driver{};
            driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
            VkPhysicalDeviceProperties2 properties{};
            properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
            properties.pNext = &driver;
            vkGetPhysicalDeviceProperties2(handles[i], &properties);
            info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
        }
        if (basic.apiVersion < VK_API_VERSION_1_3) {
            info.unusable = "Vulkan " + version_text(basic.apiVersion) + ", needs 1.3";
        } else if (!has_graphics_queue(handles[i])) {
            info.unusable = "no queue for both graphics and compute";
        }
        devices.push_back(info);
    }
    return devices;
}

DeviceChoice parse_device_choice(std::string_view text) {
    if (text == "auto") return {DeviceChoice::Kind::automatic, 0};
    if (text == "cpu") return {DeviceChoice::Kind::cpu, 0};
    DeviceChoice choice{DeviceChoice::Kind::index, 0};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), choice.index);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw UsageError("--device: '" + std::string(text) + "', expected auto, cpu or an index (see --list-devices)");
    }
    return choice;
}

DeviceInfo choose_device(const std::vector<DeviceInfo>& devices, const DeviceChoice& choice) {
    if (devices.empty()) throw DeviceError(std::string("no Vulkan device") + kInstallHint);
    if (choice.kind == DeviceChoice::Kind::index) {
        if (choice.index >= devices.size()) {
            throw DeviceError("no Vulkan device " + std::to_string(choice.index) + ": there are " +
                              std::to_string(devices.size()) + " (see --list-devices)");
        }
        const DeviceInfo& device = devices[choice.index];
        if (!device.unusable.empty()) throw DeviceError("Vulkan device '" + device.name + "': " + device.unusable);
        return device;
    }
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& device : devices) {
        if (!device.unusable.empty()) continue;
        if (choice.kind == DeviceChoice::Kind::cpu && !device.is_cpu()) continue;
        if (!best || rank(device) < rank(*best)) best = &device;
    }
    if (!best) {
        const bool cpu = choice.kind == DeviceChoice::Kind::cpu;
        const std::string found = cpu ? "" : " ('" + devices[0].name + "': " + devices[0].unusable + ")";
        throw DeviceError((cpu ? "no software Vulkan device" : "no usable Vulkan device" + found) + kInstallHint);
    }
    return *best;
}

}  // namespace splice::gpu
