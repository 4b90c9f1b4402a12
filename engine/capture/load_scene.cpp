#include "engine/capture/load_scene.h"

#include "engine/scene/gpu_model.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <tuple>

namespace splice {

namespace {

enum class FileKind { kModel, kScene, kMesh };

FileKind kind_of_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SystemError("cannot read " + path.string() + ": " + std::strerror(errno));
    std::array<char, 256> start{};
    file.read(start.data(), start.size());
    const std::string_view text(start.data(), static_cast<std::size_t>(file.gcount()));
    if (text.starts_with("SPLICE") || path.extension() == ".splice") return FileKind::kModel;
    if (path.extension() == ".json") return FileKind::kScene;
    for (const char c : text)
        if (std::isspace(static_cast<unsigned char>(c)) == 0) return c == '{' ? FileKind::kScene : FileKind::kMesh;
    return FileKind::kMesh;
}

// Where a scene names a file that is not there or wants a model file baked anew, the scene is what is wrong.
void check_model_file(const SceneModel& model, const std::filesystem::path& path, const std::string& scene_name,
                      const std::string& place) {
    if (!std::ifstream(path, std::ios::binary))
        throw InputError(scene_name, place + "/file", "cannot read " + path.string() + ": " + std::strerror(errno));
    if (!model.bake_members.empty() && kind_of_file(path) == FileKind::kModel)
        throw InputError(scene_name, place + "/" + model.bake_members.front(),
                         "expected a mesh or a shape beside it, got a model file, which is baked already");
}

// What makes two models of a scene the same: where they come from and how they are baked.
using ModelKey = std::tuple<std::string, std::map<std::string, double>, SceneRepresentation, double, double>;

class Loader {
  public:
    Loader(Renderer& renderer, const Progress& progress, LoadedScene& loaded)
        : renderer_(renderer), progress_(progress), loaded_(loaded) {}

    std::shared_ptr<const GpuModel> load(const SceneModel& model, const std::string& scene_name,
                                         const std::string& place) {
        const auto* shape = std::get_if<ShapeDescription>(&model.source);
        const auto* path = std::get_if<std::filesystem::path>(&model.source);
        if (path) check_model_file(model, *path, scene_name, place);
        const ModelKey key{shape ? "shape " + shape->kind : "file " + path->string(),
                           shape ? shape->parameters : std::map<std::string, double>{}, model.representation,
                           model.triangle_share.value_or(-1), model.max_spacing.value_or(-1)};
        auto& entry = models_[key];
        if (!entry) entry = shape ? bake_shape(model, *shape, scene_name, place + "/shape") : load_file(model, *path);
        return entry;
    }

  private:
    static BakeOptions bake_options(const SceneModel& model) {
        BakeOptions options;
        switch (model.representation) {
            case SceneRepresentation::kHybrid:
                options.cluster.representation = ForcedRepresentation::kHybrid;
                break;
            case SceneRepresentation::kTriangles:
                options.cluster.representation = ForcedRepresentation::kTriangles;
                break;
            case SceneRepresentation::kSurfels:
                options.cluster.representation = ForcedRepresentation::kSurfels;
                break;
        }
        options.cluster.triangle_share = model.triangle_share;
        if (model.max_spacing) {
            options.sampling.h_max = *model.max_spacing;
            options.sampling.h_min = std::min(options.sampling.h_min, *model.max_spacing);
        }
        return options;
    }

    std::shared_ptr<const GpuModel> load_file(const SceneModel& model, const std::filesystem::path& path) {
        switch (kind_of_file(path)) {
            case FileKind::kModel:
                return renderer_.load(ModelFile(path).view());
            case FileKind::kScene:
                throw InputError(path.string(), "", "a scene file where a model or a mesh is expected");
            case FileKind::kMesh:
                break;
        }
        BakeStats stats;
        const Model baked = bake_file(path, bake_options(model), stats, progress_);
        loaded_.warnings.insert(loaded_.warnings.end(), stats.warnings.begin(), stats.warnings.end());
        return renderer_.load(view_of(baked));
    }

    std::shared_ptr<const GpuModel> bake_shape(const SceneModel& model, const ShapeDescription& shape,
                                               const std::string& scene_name, const std::string& place) {
        const BakeOptions options = bake_options(model);
        RepairReport report;
        BakeStats stats;
        IndexedMesh mesh = repair_mesh(make_shape(shape, scene_name, place), options.repair, report, shape.kind);
        return renderer_.load(view_of(build_model(std::move(mesh), options, stats, progress_)));
    }

    Renderer& renderer_;
    const Progress& progress_;
    LoadedScene& loaded_;
    std::map<ModelKey, std::shared_ptr<const GpuModel>> models_;
};

// unit_box: the description's transform applies to unit-box units instead of the file's.
Transform source_transform(const SceneModel& model, const format::ModelInfo& info) {
    if (!model.unit_box) return model.transform;
    Transform transform = model.transform;
    transform.scale /= info.source_scale;
    transform.translation -= transform.rotation *
                             glm::dvec3(info.source_offset[0], info.source_offset[1], info.source_offset[2]) *
                             transform.scale;
    return transform;
}

}  // namespace

std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files = {path};
    if (kind_of_file(path) != FileKind::kScene) return files;
    for (const SceneModel& model : read_scene_file(path).models)
        if (const auto* file = std::get_if<std::filesystem::path>(&model.source)) files.push_back(*file);
    return files;
}

LoadedScene load_scene(const std::filesystem::path& path, Renderer& renderer, const Progress& progress) {
    LoadedScene loaded;
    if (kind_of_file(path) == FileKind::kScene) {
        loaded.description = read_scene_file(path);
    } else {
        SceneModel model;
        model.source = path;
        loaded.description.models.push_back(std::move(model));
    }
    Loader loader(renderer, progress, loaded);
    for (std::size_t i = 0; i < loaded.description.models.size(); ++i) {
        const SceneModel& model = loaded.description.models[i];
        const auto on_device = loader.load(model, path.string(), "/models/" + std::to_string(i));
        loaded.scene.instances.push_back({on_device, source_transform(model, on_device->info())});
    }
    loaded.scene.lighting = loaded.description.lighting;
    loaded.scene.background = loaded.description.background;
    return loaded;
}

}  // namespace splice
