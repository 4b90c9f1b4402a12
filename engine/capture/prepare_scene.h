// From files to models in memory: model files mapped, meshes and procedural shapes baked. No device, so any thread may.
#pragma once

#include "engine/scene/scene_file.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/model_format/model.h"
#include "preprocess/progress.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace splice {

/// A model in memory: a mapped file, or what a bake made.
class HostModel {
  public:
    explicit HostModel(ModelFile file) : source_(std::move(file)), view_(std::get<ModelFile>(source_).view()) {}
    explicit HostModel(Model model) : source_(std::move(model)), view_(view_of(std::get<Model>(source_))) {}
    HostModel(const HostModel&) = delete;
    HostModel& operator=(const HostModel&) = delete;
    const ModelView& view() const { return view_; }
    /// Lets go of the memory that holds a part of the view's bytes, where they can be read again.
    void release(std::span<const std::byte> part) const {
        if (const auto* file = std::get_if<ModelFile>(&source_)) file->release(part);
    }
    /// From a mesh or a shape, so that it can be baked again in another way.
    bool baked() const { return std::holds_alternative<Model>(source_); }

  private:
    std::variant<ModelFile, Model> source_;
    ModelView view_;
};

struct PreparedScene {
    SceneDescription description;  // of models and meshes: default lights, default framing; says how they were baked
    bool from_scene_file = false;
    std::vector<std::shared_ptr<const HostModel>> models;  // one an entry of description.models; equal ones are one
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> companions;  // files that were read because a mesh names them
};

struct PrepareOptions {
    std::optional<BakeOptions> bake = {};  // of every mesh and shape, in place of what the scene says
    int threads = 0;                       // for bakes; 0: one a core
};

/// One scene file; or models and meshes, in the coordinates of their files. By content first (model files, JSON), else
/// as a mesh. Throws InputError, SystemError, UsageError (a scene file beside others).
PreparedScene prepare_scene(const std::vector<std::filesystem::path>& paths, const PrepareOptions& options = {},
                            const Progress& progress = {});

/// world = rotation * (scale * file) + translation of an entry of a description, unit_box resolved.
Transform source_transform(const SceneModel& model, const format::ModelInfo& info);

/// The files that prepare_scene reads: `path`, and the models and meshes that it names if it is a scene. Throws the
/// same.
std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& path);

/// The mesh of a shape; kinds and parameters as in docs/scene_format.md. Throws InputError("NAME: PATH: ...").
SourceMesh make_shape(const ShapeDescription& shape, const std::string& name, const std::string& path);

}  // namespace splice
