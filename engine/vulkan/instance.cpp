#include "engine/vulkan/instance.h"

#include "engine/vulkan/handle.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>

namespace splice::gpu {

struct ValidationLog {
    std::mutex mutex;
    std::vector<ValidationMessage> messages;
};

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto* log = static_cast<ValidationLog*>(user);
    const std::scoped_lock lock(log->mutex);
    log->messages.push_back({severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
                             data->pMessageIdName ? data->pMessageIdName : "", data->pMessage ? data->pMessage : ""});
    return VK_FALSE;
}

bool has_layer(const char* name) {
    uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "listing the Vulkan layers");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "listing the Vulkan layers");
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool has_extension(const char* layer, const char* name) {
    uint32_t count = 0;
    check(vkEnumerateInstanceExtensionProperties(layer, &count, nullptr), "listing the Vulkan extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()), "listing the Vulkan extensions");
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

}  // namespace

Instance::Instance(const InstanceOptions& options) : log_(std::make_unique<ValidationLog>()) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = options.application.c_str();
    application.pEngineName = "splice";
    application.apiVersion = VK_API_VERSION_1_3;

    std::vector<const char*> layers, extensions;
    for (const std::string& extension : options.extensions)
        extensions.push_back(extension.c_str());
    if (options.validate) {
        if (!has_layer(kValidationLayer)) {
            throw DeviceError(
                "the Vulkan validation layer is not installed; `apt install vulkan-validationlayers` provides it");
        }
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    debug_utils_ = options.validate || has_extension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debug_utils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                            VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = collect;
    messenger.pUserData = log_.get();

    const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = static_cast<uint32_t>(enabled.size());
    features.pEnabledValidationFeatures = enabled.data();
    features.pNext = &messenger;  // also hears what vkCreateInstance and vkDestroyInstance themselves say

    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pNext = options.validate ? &features : nullptr;
    create.pApplicationInfo = &application;
    create.enabledLayerCount = static_cast<uint32_t>(layers.size());
    create.ppEnabledLayerNames = layers.data();
    create.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    const VkResult result = vkCreateInstance(&create, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER || result == VK_ERROR_INITIALIZATION_FAILED) {
        throw DeviceError("no Vulkan driver; `apt install mesa-vulkan-drivers` provides a software one (lavapipe)");
    }
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        throw DeviceError("no Vulkan driver can draw in windows of this display");
    check(result, "creating the Vulkan instance");

    if (options.validate) {
        const auto make = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        const VkResult made = make ? make(instance_, &messenger, nullptr, &messenger_) : VK_ERROR_EXTENSION_NOT_PRESENT;
        if (made != VK_SUCCESS) {
            vkDestroyInstance(instance_, nullptr);
            check(made, "listening to the Vulkan validation layer");
        }
    }
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        if (destroy) destroy(instance_, messenger_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

std::vector<ValidationMessage> Instance::messages() const {
    const std::scoped_lock lock(log_->mutex);
    return log_->messages;
}

}  // namespace splice::gpu
