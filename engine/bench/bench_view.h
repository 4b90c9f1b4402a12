// What the two quality benchmarks share: a mesh, what it is baked to, and the cameras it is seen from.
#pragma once

#include "engine/bench/bench_quality.h"

#include <string_view>

namespace splice::bench {

struct NamedCamera {
    std::string name;  // "default", or the direction of the eye like "+x-y"
    Camera camera;
};

std::vector<NamedCamera> bench_cameras(const Box& bounds, const QualityOptions& options);

/// Bakes a copy of `mesh` and puts it on the device.
struct BakedModel {
    Model model;
    BakeStats stats;
    std::shared_ptr<const GpuModel> on_device;
};
BakedModel bake_for(Renderer& renderer, const IndexedMesh& mesh, const BakeOptions& options,
                    ForcedRepresentation representation);

/// Tells the terminal what is going on; an empty text wipes the line. Nothing where stderr is no terminal.
void show_progress(std::string_view text);

}  // namespace splice::bench
