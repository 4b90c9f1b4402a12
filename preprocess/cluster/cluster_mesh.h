// Two-phase hierarchical face clustering (Ni 2005, 3.2.2-3.2.3, after Garland, Willmott and Heckbert 2001).
#pragma once

#include "preprocess/cluster/patch_set.h"
#include "preprocess/progress.h"

#include <optional>

namespace splice {

enum class Selection {
    kGeometric,  // default: an absolute, scale-free criterion of how rough a patch is
    kThesis,     // the published two-phase cost with its thresholds
};
enum class ForcedRepresentation { kHybrid, kTriangles, kSurfels };

struct ClusterOptions {
    Selection selection = Selection::kGeometric;
    ForcedRepresentation representation = ForcedRepresentation::kHybrid;
    std::optional<double>
        triangle_share;  // 0..1: share of the input's triangles kept as triangles; overrides the criterion
    std::optional<double> phase1_cost;  // merge while cost <= this; larger merges more (the thesis prints the negative)
    std::optional<double> phase2_cost;
    std::optional<double> max_patch_area;  // share of the surface's area, 0..1
};

/// Deterministic; the result does not depend on the number of threads.
PatchSet cluster_mesh(const IndexedMesh& mesh, const ClusterOptions& options, const Progress& progress = {});

}  // namespace splice
