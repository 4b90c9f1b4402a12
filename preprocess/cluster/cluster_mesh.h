// Two-phase hierarchical face clustering (Ni 2005, 3.2.2-3.2.3, after Garland, Willmott and Heckbert 2001).
//
// Clusters start as single faces; the cheapest pair of neighbours is contracted again and again, and the contractions
// are kept as a merge tree. Phase one makes clusters that are flat and round, up to a largest area. What is to be drawn
// as triangles stays as phase one left it; phase two merges the rest by shape and size alone into surfel patches.
//
// Costs, each dimensionless or in unit-box units (positions inside the unit box):
//   E_fit    mean squared distance of the vertices to the least-squares plane         (eq. 3.9, n^T v for the printed n
//   v^T) E_dir    (1/w) sum w_i (1 - n.n_i)^2 over faces of area w_i, n the plane's normal turned to the mean normal
//   (eq. 3.14) E_shape  (gamma - max(gamma_a, gamma_b)) / gamma, gamma = perimeter^2 / (4 pi area) >= 1 of the union
//   and its parts E_turn   (spread of the normals / 10 degrees)^2 E_size   area of the union / largest area
//
// Sign: these are costs and a pair is merged while cost <= threshold, so a larger threshold merges more. The thesis
// keys its heap on the negated cost and says "higher threshold, more clusters": its 0.033, -0.19 and -0.96 (fig. 4.1)
// are thresholds of -0.033, 0.19 and 0.96 here.
//
// Selection::kGeometric (default) scores how rough each place is (selection.h says how, in one formula), and lets the
// score's threshold divide the surface before phase one: E_shape + E_turn merges flat with flat and rough with rough
// only, normals of a cluster spread by at most 10 degrees, and small doubtful clusters join a larger neighbour. Phase
// two: E_shape + E_size <= 0.9 among the rough. Selection::kThesis is the publication: E_fit + E_dir + E_shape <=
// 0.1625, then E_shape + E_size <= 1.8 among all; what phase two did not touch is triangles. The thresholds and the
// largest area, 5.69 median triangles, reproduce the published shares of triangles kept; where they end up is next to
// chance on scans.
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
        triangle_share;                 // 0..1: share of the input's triangles kept as triangles: the least rough ones
    std::optional<double> phase1_cost;  // merge while cost <= this; default: geometric none, thesis 0.1625
    std::optional<double> phase2_cost;  // likewise; default: geometric 0.9, thesis 1.8
    std::optional<double>
        max_patch_area;  // share of the surface's area, above 0, at most 1; default: geometric 0.002 of
                         // what is not larger triangles, but 16 median triangles; thesis 5.69 of them
};

/// The mesh must hold the invariants of IndexedMesh. An edge with three or more faces is a border between patches, and
/// so is an edge between materials. Deterministic; the result does not depend on the number of threads. Throws
/// UsageError for options out of range.
PatchSet cluster_mesh(const IndexedMesh& mesh, const ClusterOptions& options, const Progress& progress = {});

}  // namespace splice
