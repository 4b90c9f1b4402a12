// The Vulkan instance, with the validation layers on request.
#pragma once

#include <vulkan/vulkan_core.h>

#include <memory>
#include <string>
#include <vector>

namespace splice::gpu {

struct InstanceOptions {
    std::string application = "splice";
    /// Validation and synchronisation validation (VK_LAYER_KHRONOS_validation). Warnings and errors are collected, not
    /// printed: a program checks messages() at its end and fails on any.
    bool validate = false;
    /// Instance extensions that the caller needs, such as a window system's.
    std::vector<std::string> extensions = {};
};

struct ValidationMessage {
    bool error = false;  ///< else a warning
    std::string id;      ///< e.g. "VUID-vkCmdDraw-None-02700", "SYNC-HAZARD-READ-AFTER-WRITE"
    std::string text;
};

struct ValidationLog;  // shared with the layers' callback, which any thread may enter

class Instance {
  public:
    /// Throws DeviceError when there is no Vulkan loader or driver, or when validation is asked for and the layer is
    /// not installed; both say which package to install.
    explicit Instance(const InstanceOptions& options = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return instance_; }
    /// Debug names and labels are recorded only where something can show them (a layer or a capture tool).
    bool debug_utils() const { return debug_utils_; }

    /// Everything that the layers said so far, at severity warning or error, in order.
    std::vector<ValidationMessage> messages() const;

  private:
    std::unique_ptr<ValidationLog> log_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool debug_utils_ = false;
};

}  // namespace splice::gpu
