// The choice of a frame's level of detail (Pajarola et al. 2004, section 6.2): a cut through a point tree, made of
// nodes that are drawn as one elliptical splat each and of surfels, so that every surfel that may be seen is in it
// once, itself or in one node above it.
//
// With two corrections and one change. A node faces away if its normals do from everywhere in its sphere, not only from
// its centre; tilt does not shrink a node, whose length across the view stays. What is bounded is not the area of a
// projected ellipse as a share of the picture but its major diameter in pixels, so that a long thin ellipse does not
// pass: nothing is drawn farther than `tau` from what it stands for. At 1 a pixel holds an ellipse whole.
#pragma once

#include "engine/scene/point_hierarchy.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace splice {

/// Where a model is seen from.
struct CutView {
    glm::dmat4 model_to_view{1.0};  // from unit-box units
    double scale = 1;               // world units per unit-box unit
    bool orthographic = false;
    double pixel_scale = 1;         // pixels per unit at depth 1, or anywhere
    double half_x = 1, half_y = 1;  // of the picture, at depth 1 or anywhere
    double near_plane = 1e-3;       // depth, world units
    bool two_sided = false;         // nothing is left out because of its normals
    double tau = 1;                 // pixels, above 0: the longest that an ellipse may be, from end to end
    double max_point_size = 255;    // pixels; see CutRun::fits_point
    // By how much drawing a patch's triangles costs more than drawing no surfel of it, in splats; empty: no patch is
    // drawn by its triangles.
    std::span<const double> triangle_costs;
    // Surfels that something else is drawn for: begin, end, ascending; each all those of a node.
    std::span<const std::pair<std::uint32_t, std::uint32_t>> left_out;
};

/// Consecutive surfels, or nodes, of the model.
struct CutRun {
    std::uint32_t first = 0, count = 0;
    bool inner = false;       // nodes
    bool fits_point = false;  // wholly inside the frustum, and none is wider than the largest point
    std::uint32_t level = 0;  // of nodes, their depth in the tree, counted from 1; of surfels 0
    friend bool operator==(const CutRun&, const CutRun&) = default;
};

struct CutStatistics {
    std::uint64_t visited = 0;                           // nodes
    std::uint64_t outside_frustum = 0, facing_away = 0;  // nodes at which the walk ended
    std::uint64_t ellipses = 0;                          // nodes that are drawn in place of what is below them
    std::uint64_t merged_surfels = 0;                    // those below them
    std::uint64_t surfels = 0;                           // drawn themselves
    std::uint64_t patches_by_triangles = 0;              // surfel patches whose triangles cost less
    std::uint64_t groups_by_triangles = 0;               // nodes of the octree drawn as a whole by triangles
    CutStatistics& operator+=(const CutStatistics& other);
    friend bool operator==(const CutStatistics&, const CutStatistics&) = default;
};

struct LodCut {
    std::vector<CutRun> runs;                     // in the order of the surfels they stand for
    std::vector<std::uint32_t> triangle_patches;  // surfel patches that are in the cut by their triangles
    CutStatistics statistics;
};

/// Where the cut reaches a patch, its triangles take the place of what it would have of it if they cost less.
/// Deterministic for any thread count.
LodCut cut_points(const PointHierarchy& hierarchy, const CutView& view);

}  // namespace splice
