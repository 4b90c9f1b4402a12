// A baked mesh for tests of frames.
#pragma once

#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/shapes.h"

namespace splice::test {

/// Half triangles, half surfels.
inline Model mesh_model() {
    RepairReport report;
    BakeOptions options;
    options.cluster.triangle_share = 0.5;
    BakeStats stats;
    return build_model(repair_mesh(shapes::bumpy_sphere(20'000), {}, report, "bumpy sphere"), options, stats);
}

}  // namespace splice::test
