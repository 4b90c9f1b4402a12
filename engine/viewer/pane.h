// A picture of the scene that stays on the device until something it shows changes.
#pragma once

#include "engine/capture/capture.h"
#include "engine/vulkan/image.h"

#include <cstdint>

namespace splice {

class Pane {
  public:
    /// Draws the scene anew if settings or `revision` (of everything else that the picture depends on) differ from the
    /// last time, or surfels that the last picture lacked were read meanwhile. True if it did.
    bool update(gpu::Device& device, Renderer& renderer, const Scene& scene, std::uint64_t revision,
                const CaptureSettings& settings);

    /// Whether surfels that the picture lacks are being read.
    bool is_refining(const Scene& scene) const;
    bool empty() const { return !image_; }
    const gpu::Image& image() const { return image_; }  // in TRANSFER_SRC_OPTIMAL
    const FrameStats& stats() const { return stats_; }  // of the last drawing
    const CaptureSettings& settings() const { return settings_; }

  private:
    gpu::Image image_;
    CaptureSettings settings_;
    std::uint64_t revision_ = 0;
    FrameStats stats_;
};

}  // namespace splice
