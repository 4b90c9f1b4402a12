// What the sprite backend is held to: the same point sprites with the same shaders, in one render pass written by hand,
// without a render graph, a scene, culling of patches, or quads for what does not fit a point.
#pragma once

#include "engine/capture/capture.h"
#include "preprocess/model_format/model.h"

#include <memory>
#include <string>

namespace splice::bench {

class BareSprites {
  public:
    /// `device`: as RendererOptions::device. Unit-box units of the model are world units. Throws DeviceError.
    BareSprites(const std::string& device, const Model& model);
    BareSprites(const BareSprites&) = delete;
    BareSprites& operator=(const BareSprites&) = delete;
    ~BareSprites();

    /// Size, camera with its clip planes, and prefilter; the default scene's light, a white background.
    FrameStats render(const CaptureSettings& settings);
    /// Rows top to bottom, as Frame::rgba with alpha as coverage, of the last frame.
    std::vector<std::uint8_t> picture() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace splice::bench
