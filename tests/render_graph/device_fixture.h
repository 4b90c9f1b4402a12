// A device with both kinds of validation switched on, and a target that tests read back.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/instance.h"

#include <string>

namespace splice::test {

/// A false alarm (1.3.239) of frames whose passes draw nothing: the layers see no sampled read; of write, barrier,
/// read, barrier, transition they see the write and the transition, whose barrier waits for the reader's stage alone,
/// and do not follow the chain of the two barriers. They do say that the write had its barrier.
inline bool is_unseen_read(const gpu::ValidationMessage& message) {
    const auto says = [&](const char* words) { return message.text.find(words) != std::string::npos; };
    return says("usage: SYNC_IMAGE_LAYOUT_TRANSITION, prior_usage") &&
           says("ATTACHMENT_WRITE, write_barriers: SYNC_") && says("SHADER_SAMPLED_READ");
}

struct ValidatedDevice {
    explicit ValidatedDevice(bool force_staging = false)
        : instance({.application = "splice tests", .validate = true}),
          device(instance, {.choice = {gpu::DeviceChoice::Kind::automatic, 0}, .force_staging = force_staging}) {}

    /// Everything the layers said, one message a line; empty when all is well.
    std::string complaints() const {
        return complaints([](const gpu::ValidationMessage&) { return false; });
    }
    /// But for those expected.
    template <typename Expected>
    std::string complaints(const Expected& is_expected) const {
        std::string text;
        for (const gpu::ValidationMessage& message : instance.messages())
            if (!is_expected(message)) text += message.text + "\n";
        return text;
    }

    gpu::Instance instance;
    gpu::Device device;
};

}  // namespace splice::test
