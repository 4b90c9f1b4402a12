// The preprocessor's pipeline: file -> Model. One short function that reads as the list of stages.
#pragma once

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
    int threads = 0;  // 0: one a core
};

struct BakeStats {
    RepairReport repair;
    ClusterStats cluster;
    SurfelStats surfel;
    std::vector<std::string> warnings;
    std::uint64_t vertices = 0, triangles = 0;  // of the repaired mesh
    double seconds_read = 0, seconds_repair = 0, seconds_cluster = 0, seconds_simplify = 0, seconds_sample = 0,
           seconds_prune = 0, seconds_assemble = 0, seconds_total = 0;
};

/// A mesh in memory -> Model. Throws InputError.
Model build_model(IndexedMesh mesh, const BakeOptions& options, BakeStats& stats, const Progress& progress = {});

/// A mesh file -> Model: read, repair, build. Throws InputError, SystemError.
Model bake_file(const std::filesystem::path& path, const BakeOptions& options, BakeStats& stats,
                const Progress& progress = {});

}  // namespace splice
