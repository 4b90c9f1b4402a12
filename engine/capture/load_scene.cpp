#include "engine/capture/load_scene.h"

#include "engine/scene/gpu_model.h"

#include <map>

namespace splice {

LoadedScene upload_scene(const PreparedScene& prepared, Renderer& renderer) {
    LoadedScene loaded;
    loaded.description = prepared.description;
    loaded.warnings = prepared.warnings;
    std::map<const HostModel*, std::shared_ptr<const GpuModel>> uploaded;
    for (std::size_t i = 0; i < prepared.models.size(); ++i) {
        auto& on_device = uploaded[prepared.models[i].get()];
        if (!on_device) on_device = renderer.load(prepared.models[i]->view());
        loaded.scene.instances.push_back(
            {on_device, source_transform(prepared.description.models[i], on_device->info())});
    }
    loaded.scene.lighting = loaded.description.lighting;
    loaded.scene.background = loaded.description.background;
    return loaded;
}

LoadedScene load_scene(const std::filesystem::path& path, Renderer& renderer, const Progress& progress) {
    return upload_scene(prepare_scene({path}, {}, progress), renderer);
}

}  // namespace splice
