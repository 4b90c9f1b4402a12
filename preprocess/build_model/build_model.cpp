#include "preprocess/build_model/build_model.h"

#include "preprocess/build_model/assemble_cloud.h"
#include "preprocess/build_model/assemble_model.h"
#include "preprocess/build_model/workers_aside.h"
#include "preprocess/cloud/orient_normals.h"
#include "preprocess/cloud/read_point_cloud.h"
#include "preprocess/model_format/error.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <utility>

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

// In an arena, not under a tbb::global_control: when that ends, the library makes the threads that it held back, and
// where there is no memory for them it ends the program.
template <typename Body>
auto with_threads(int threads, const Body& body) {
    if (threads <= 0) return body();
    tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
    return arena.execute(body);
}

Model build_mesh_model(IndexedMesh mesh, const BakeOptions& options, BakeStats& stats, const Progress& progress) {
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

    const PatchLayout layout =
        timed(progress, "order", stats.seconds_assemble, [&] { return lay_out_patches(vertices, lods, surfels); });
    RegionLods regions;
    if (options.simplify.levels > 1) {
        regions = timed(progress, "levels", stats.seconds_simplify, [&] {
            return simplify_regions(mesh, vertices, patches, layout.order, layout.octree, progress);
        });
    }
    Model model = timed(progress, "assemble", stats.seconds_assemble,
                        [&] { return assemble_model(mesh, patches, vertices, lods, surfels, layout, regions); });
    stats.seconds_total += total.seconds();
    return model;
}

Model build_points_model(PointCloud cloud, const BakeOptions& options, BakeStats& stats, const Progress& progress) {
    const Stopwatch total;
    if (options.cluster.representation == ForcedRepresentation::kTriangles)
        throw UsageError("a point cloud has no triangles to draw: leave --representation triangles away");
    CloudStats& counts = stats.cloud.emplace();
    counts.source_points = cloud.source_points;
    counts.nonfinite_points = cloud.nonfinite_points;
    counts.withheld_points = cloud.withheld_points;

    const UnitCloud unit =
        timed(progress, "sort", counts.seconds_sort, [&] { return make_unit_cloud(std::move(cloud)); });
    counts.duplicate_points = unit.duplicate_points;
    counts.points = unit.positions.size();

    CloudSurface surface = timed(progress, "surface", counts.seconds_surface,
                                 [&] { return estimate_surface(unit, options.cloud, progress); });
    counts.plane_neighbours = surface.plane_neighbours;
    counts.estimated_normals = surface.estimated_normals;
    counts.border_points = surface.border_points;
    counts.isolated_points = surface.isolated_points;
    // Normals of the file know their side.
    if (unit.normals.empty()) {
        counts.components = timed(progress, "orient", counts.seconds_orient, [&] {
            return orient_normals(unit.positions, surface.neighbours, surface.disks).components;
        });
    }
    std::vector<StoredNeighbours>().swap(surface.neighbours);
    Model model = timed(progress, "assemble", stats.seconds_assemble, [&] { return assemble_cloud(unit, surface); });
    stats.cluster.surfel_patches = model.patches.size();
    stats.surfel.surfels = model.packed_surfels.size();
    stats.seconds_total += total.seconds();
    return model;
}

Model read_and_build(const std::filesystem::path& path, const BakeOptions& options, BakeStats& stats,
                     const Progress& progress) {
    const Stopwatch preparation;
    const WorkersAside workers;
    SourceFile file;
    PointCloud cloud;
    SourceMesh source;
    const bool is_cloud = timed(progress, "read", stats.seconds_read, [&] {
        file = load_source_file(path);
        if (is_point_cloud(file)) {
            cloud = parse_point_cloud(file);
            return true;
        }
        source = parse_mesh_file(file);
        return false;
    });
    std::string().swap(file.bytes);
    if (is_cloud) {
        stats.warnings = cloud.warnings;
        stats.seconds_total += preparation.seconds();
        return build_cloud_model(std::move(cloud), options, stats, progress);
    }
    stats.warnings = source.warnings;
    stats.companions = source.companions;
    IndexedMesh mesh = timed(progress, "repair", stats.seconds_repair, [&] {
        return repair_mesh(std::move(source), options.repair, stats.repair, path.string());
    });
    stats.seconds_total += preparation.seconds();
    return build_model(std::move(mesh), options, stats, progress);
}

}  // namespace

Model build_model(IndexedMesh mesh, const BakeOptions& options, BakeStats& stats, const Progress& progress) {
    return with_threads(options.threads, [&] { return build_mesh_model(std::move(mesh), options, stats, progress); });
}

Model build_cloud_model(PointCloud cloud, const BakeOptions& options, BakeStats& stats, const Progress& progress) {
    return with_threads(options.threads,
                        [&] { return build_points_model(std::move(cloud), options, stats, progress); });
}

Model bake_file(const std::filesystem::path& path, const BakeOptions& options, BakeStats& stats,
                const Progress& progress) {
    return with_threads(options.threads, [&] { return read_and_build(path, options, stats, progress); });
}

}  // namespace splice
