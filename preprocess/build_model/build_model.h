// The preprocessor's pipeline: file -> Model. One short function that reads as the list of stages.
#pragma once

#include "preprocess/cloud/cloud_surface.h"
#include "preprocess/cluster/cluster_mesh.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/model_format/model.h"
#include "preprocess/simplify/simplify_patches.h"
#include "preprocess/surfel/surfel_set.h"

namespace splice {

struct BakeOptions {
    RepairOptions repair;
    ClusterOptions cluster;
    SamplingOptions sampling;
    SimplifyOptions simplify;
    CloudOptions cloud;
    int threads = 0;  // 0: one a core
};

/// Counts of points, where the input was a point cloud.
struct CloudStats {
    std::uint64_t source_points = 0;     // as the file has them
    std::uint64_t nonfinite_points = 0;  // dropped
    std::uint64_t withheld_points = 0;   // dropped: marked as deleted
    std::uint64_t duplicate_points = 0;  // dropped
    std::uint64_t points = 0;            // the others: one surfel each
    int plane_neighbours = 0;
    std::uint64_t estimated_normals = 0, components = 0, border_points = 0, isolated_points = 0;  // cloud_surface.h
    double seconds_sort = 0, seconds_surface = 0, seconds_orient = 0;
};

struct BakeStats {
    std::optional<CloudStats> cloud;
    RepairReport repair;
    ClusterStats cluster;
    SurfelStats surfel;
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> companions;  // files that were read because the input names them
    std::uint64_t vertices = 0, triangles = 0;      // of the repaired mesh
    double seconds_read = 0, seconds_repair = 0, seconds_cluster = 0, seconds_simplify = 0, seconds_sample = 0,
           seconds_prune = 0, seconds_assemble = 0, seconds_total = 0;
};

/// A mesh in memory -> Model. Throws InputError.
Model build_model(IndexedMesh mesh, const BakeOptions& options, BakeStats& stats, const Progress& progress = {});

/// A point cloud in memory -> Model. Throws Error.
Model build_cloud_model(PointCloud cloud, const BakeOptions& options, BakeStats& stats, const Progress& progress = {});

/// A mesh or point cloud file -> Model: read, repair, build. Throws InputError, SystemError.
Model bake_file(const std::filesystem::path& path, const BakeOptions& options, BakeStats& stats,
                const Progress& progress = {});

}  // namespace splice
