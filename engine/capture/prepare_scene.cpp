#include "engine/capture/prepare_scene.h"

#include "engine/capture/bake_of_scene.h"
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
using ModelKey =
    std::tuple<std::string, std::map<std::string, double>, SceneRepresentation, SceneSelection, double, double, double>;

class Preparer {
  public:
    Preparer(const PrepareOptions& options, const Progress& progress, PreparedScene& prepared)
        : options_(options), progress_(progress), prepared_(prepared) {}

    std::shared_ptr<const HostModel> prepare(const SceneModel& model, const std::string& scene_name,
                                             const std::string& place) {
        const auto* shape = std::get_if<ShapeDescription>(&model.source);
        const auto* path = std::get_if<std::filesystem::path>(&model.source);
        if (path) check_model_file(model, *path, scene_name, place);
        const ModelKey key{shape ? "shape " + shape->kind : "file " + path->string(),
                           shape ? shape->parameters : std::map<std::string, double>{},
                           model.representation,
                           model.selection,
                           model.triangle_share.value_or(-1),
                           model.sampling.value_or(-1),
                           model.max_spacing.value_or(-1)};
        auto& entry = models_[key];
        if (!entry) entry = shape ? bake_shape(model, *shape, scene_name, place + "/shape") : read_file(model, *path);
        return entry;
    }

  private:
    BakeOptions bake_options(const SceneModel& model) const {
        BakeOptions options = options_.bake.value_or(bake_of(model));
        options.threads = options_.threads;
        return options;
    }

    std::shared_ptr<const HostModel> read_file(const SceneModel& model, const std::filesystem::path& path) {
        switch (kind_of_file(path)) {
            case FileKind::kModel:
                return std::make_shared<const HostModel>(ModelFile(path));
            case FileKind::kScene:
                throw InputError(path.string(), "", "a scene file where a model or a mesh is expected");
            case FileKind::kMesh:
                break;
        }
        BakeStats stats;
        auto baked = std::make_shared<const HostModel>(bake_file(path, bake_options(model), stats, progress_));
        const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
        append(prepared_.warnings, stats.warnings);
        append(prepared_.companions, stats.companions);
        return baked;
    }

    std::shared_ptr<const HostModel> bake_shape(const SceneModel& model, const ShapeDescription& shape,
                                                const std::string& scene_name, const std::string& place) {
        const BakeOptions options = bake_options(model);
        RepairReport report;
        BakeStats stats;
        IndexedMesh mesh = repair_mesh(make_shape(shape, scene_name, place), options.repair, report, shape.kind);
        return std::make_shared<const HostModel>(build_model(std::move(mesh), options, stats, progress_));
    }

    const PrepareOptions& options_;
    const Progress& progress_;
    PreparedScene& prepared_;  // its warnings and companions
    std::map<ModelKey, std::shared_ptr<const HostModel>> models_;
};

}  // namespace

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

std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files = {path};
    if (kind_of_file(path) != FileKind::kScene) return files;
    for (const SceneModel& model : read_scene_file(path).models)
        if (const auto* file = std::get_if<std::filesystem::path>(&model.source)) files.push_back(*file);
    return files;
}

PreparedScene prepare_scene(const std::vector<std::filesystem::path>& paths, const PrepareOptions& options,
                            const Progress& progress) {
    PreparedScene prepared;
    for (const std::filesystem::path& path : paths) {
        if (kind_of_file(path) == FileKind::kScene) {
            if (paths.size() > 1) throw UsageError(path.string() + ": a scene file is opened alone, not beside others");
            prepared.description = read_scene_file(path);
            prepared.from_scene_file = true;
        } else {
            SceneModel model;
            model.source = path;
            prepared.description.models.push_back(std::move(model));
        }
    }
    Preparer preparer(options, progress, prepared);
    const std::string name = paths.size() == 1 ? paths.front().string() : "";
    for (std::size_t i = 0; i < prepared.description.models.size(); ++i) {
        SceneModel& model = prepared.description.models[i];
        prepared.models.push_back(preparer.prepare(model, name, "/models/" + std::to_string(i)));
        if (options.bake && prepared.models.back()->baked()) describe_bake(*options.bake, model);
    }
    return prepared;
}

}  // namespace splice
