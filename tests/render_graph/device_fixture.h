// A device with both kinds of validation switched on, and a target that tests read back.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/instance.h"

#include <string>

namespace splice::test {

struct ValidatedDevice {
    explicit ValidatedDevice(bool force_staging = false)
        : instance({.application = "splice tests", .validate = true}),
          device(instance, {.choice = {gpu::DeviceChoice::Kind::automatic, 0}, .force_staging = force_staging}) {}

    /// Everything the layers said, one message a line; empty when all is well.
    std::string complaints() const {
        std::string text;
        for (const gpu::ValidationMessage& message : instance.messages())
            text += message.text + "\n";
        return text;
    }

    gpu::Instance instance;
    gpu::Device device;
};

}  // namespace splice::test
