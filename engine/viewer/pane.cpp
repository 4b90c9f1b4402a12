#include "engine/viewer/pane.h"

namespace splice {

bool Pane::update(gpu::Device& device, Renderer& renderer, const Scene& scene, std::uint64_t revision,
                  const CaptureSettings& settings) {
    if (image_ && revision == revision_ && settings == settings_) return false;
    if (!image_ || image_.options().width != settings.width || image_.options().height != settings.height) {
        image_ = gpu::Image();
        image_ = gpu::Image(device, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .width = settings.width,
                                     .height = settings.height,
                                     .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                     .name = "pane"});
    }
    stats_ = renderer.render_to(image_, scene, settings);
    settings_ = settings;
    revision_ = revision;
    return true;
}

}  // namespace splice
