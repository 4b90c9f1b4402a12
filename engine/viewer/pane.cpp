#include "engine/viewer/pane.h"

#include "engine/scene/gpu_model.h"

#include <algorithm>
#include <set>

namespace splice {

namespace {

std::set<const SurfelPager*> pagers_of(const Scene& scene) {
    std::set<const SurfelPager*> pagers;
    for (const Instance& instance : scene.instances)
        if (instance.model->pager() != nullptr) pagers.insert(instance.model->pager());
    return pagers;
}

std::uint64_t blocks_read(const Scene& scene) {
    std::uint64_t blocks = 0;
    for (const SurfelPager* pager : pagers_of(scene))
        blocks += pager->blocks_read();
    return blocks;
}

}  // namespace

bool Pane::is_refining(const Scene& scene) const {
    if (stats_.pages.missing_surfels == 0) return false;
    return blocks_read(scene) != stats_.pages.blocks_read ||
           std::ranges::any_of(pagers_of(scene), [](const SurfelPager* pager) { return pager->is_reading(); });
}

bool Pane::update(gpu::Device& device, Renderer& renderer, const Scene& scene, std::uint64_t revision,
                  const CaptureSettings& settings) {
    const bool has_news = stats_.pages.missing_surfels > 0 && blocks_read(scene) != stats_.pages.blocks_read;
    if (image_ && revision == revision_ && settings == settings_ && !has_news) return false;
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
