#include "preprocess/build_model/build_model.h"

#include "preprocess/build_model/assemble_model.h"
#include "preprocess/model_format/error.h"

#include <tbb/global_control.h>

#include <chrono>
#include <optional>

namespace splice {
namespace {

class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Announces a stage, runs it and adds the time it took to `seconds`.
template <typename Stage>
auto timed(const Progress& progress, std::string_view name, double& seconds, const Stage& stage) {
    if (progress) progress(name, 0);
    const Stopwatch watch;
    auto result = stage();
    seconds += watch.seconds();
    return result;
}

std::optional<tbb::global_control> limit_threads(int threads) {
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    return limit;
}

}  // namespace

Model build_model(IndexedMesh mesh, const BakeOptions& options, BakeStats& stats, const Progress& progress) {
    const auto limit = limit_threads(options.threads);
    const Stopwatch total;
    // Node ids of the merge tree, leaves and merges together, have 32 bits.
    if (mesh.triangles.size() >= 1u << 31) throw Error("a mesh of 2^31 triangles or more cannot be baked");
    stats.vertices = mesh.positions.size();
    stats.triangles = mesh.triangles.size();

    const PatchSet patches = timed(progress, "cluster", stats.seconds_cluster,
                                   [&] { return cluster_mesh(mesh, options.cluster, progress); });
    stats.cluster = patches.stats;
    stats.seconds_cluster -= patches.stats.seconds_judge;

    RenderVertices vertices;
    const PatchLods lods = timed(progress, "simplify", stats.seconds_simplify, [&] {
        vertices = build_render_vertices(mesh);
        return simplify_patches(mesh, vertices, patches, options.simplify, progress);
    });

    const SurfelSet surfels = sample_patches(mesh, patches, options.sampling, progress);
    stats.surfel = surfels.stats;
    stats.seconds_sample = surfels.stats.seconds_sample;
    stats.seconds_prune = surfels.stats.seconds_prune;

    Model model = timed(progress, "assemble", stats.seconds_assemble,
                        [&] { return assemble_model(mesh, patches, vertices, lods, surfels); });
    stats.seconds_total += total.seconds();
    return model;
}

Model bake_file(const std::filesystem::path& path, const BakeOptions& options, BakeStats& stats,
                const Progress& progress) {
    const auto limit = limit_threads(options.threads);
    const Stopwatch preparation;
    SourceMesh source = timed(progress, "read", stats.seconds_read, [&] { return read_mesh_file(path); });
    stats.warnings = source.warnings;
    IndexedMesh mesh = timed(progress, "repair", stats.seconds_repair, [&] {
        return repair_mesh(std::move(source), options.repair, stats.repair, path.string());
    });
    stats.seconds_total += preparation.seconds();
    return build_model(std::move(mesh), options, stats, progress);
}

}  // namespace splice
