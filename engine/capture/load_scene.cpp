#include "engine/capture/load_scene.h"

#include "engine/scene/gpu_model.h"

#include <algorithm>
#include <map>
#include <set>

namespace splice {

namespace {

double surfel_bytes(const ModelView& view) {
    return static_cast<double>(view.surfels.size_bytes() + view.packed_surfels.size_bytes());
}

Paging paging_of(const std::shared_ptr<const HostModel>& model, double share, std::uint64_t memory) {
    return {.limit = static_cast<std::uint64_t>(share * static_cast<double>(memory)),
            .owner = model,
            .release = [&source = *model](std::span<const std::byte> part) { source.release(part); }};
}

}  // namespace

LoadedScene upload_scene(const PreparedScene& prepared, Renderer& renderer, std::optional<std::uint64_t> memory) {
    LoadedScene loaded;
    loaded.description = prepared.description;
    loaded.warnings = prepared.warnings;
    loaded.companions = prepared.companions;
    std::map<const HostModel*, std::shared_ptr<const GpuModel>> uploaded;
    double all_bytes = 0;
    for (const auto& model : std::set(prepared.models.begin(), prepared.models.end()))
        all_bytes += surfel_bytes(model->view());
    for (std::size_t i = 0; i < prepared.models.size(); ++i) {
        const ModelView& view = prepared.models[i]->view();
        auto& on_device = uploaded[prepared.models[i].get()];
        if (!on_device)
            on_device = renderer.load(
                view, memory ? paging_of(prepared.models[i], surfel_bytes(view) / std::max(all_bytes, 1.0), *memory)
                             : Paging());
        loaded.scene.instances.push_back(
            {on_device, source_transform(prepared.description.models[i], on_device->info())});
    }
    loaded.scene.lighting = loaded.description.lighting;
    loaded.scene.background = loaded.description.background;
    return loaded;
}

LoadedScene load_scene(const std::filesystem::path& path, Renderer& renderer, const Progress& progress,
                       std::optional<std::uint64_t> memory) {
    return upload_scene(prepare_scene({path}, {}, progress), renderer, memory);
}

}  // namespace splice
