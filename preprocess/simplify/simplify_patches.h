// Triangle levels of detail inside each patch: quadric edge collapse (Garland and Heckbert 1997; Ni 2005, 3.2.1, 3.2.4)
// on shared vertices, with every vertex on a patch border or attribute seam locked, so that neighbours at different
// levels never crack.
#pragma once

#include "preprocess/cluster/patch_set.h"
#include "preprocess/progress.h"

#include <span>

namespace splice {

/// Corners with equal position, normal, uv and colour share a vertex. Index 3 * t + k belongs to corner k of triangle
/// t.
struct RenderVertices {
    std::vector<format::Vertex> vertices;
    std::vector<std::uint32_t> indices;   // 3 a triangle, IndexedMesh order
    std::vector<std::uint32_t> position;  // IndexedMesh position of each vertex
};
RenderVertices build_render_vertices(const IndexedMesh& mesh);

struct SimplifyOptions {
    std::uint32_t levels = 4;  // at most, the finest included; at least 1
    float reduction = 0.25f;   // least triangles of a level / triangles of the one before, in (0, 1). A patch whose
                               // borders stop it earlier divides what it can reach among fewer levels; a level
                               // that would remove under 10 % is left out
};

struct PatchLods {
    /// As format::Lod. `error`: the largest, over the collapses made, of the RMS distance (area weighted, unit-box
    /// units) between the vertex that was kept and the planes of the finest triangles it stands for.
    struct Level {
        std::uint64_t first_index;
        std::uint32_t index_count;
        float error;
    };
    std::vector<std::uint32_t> indices;  // into RenderVertices::vertices; the finest level of all patches first, patch
                                         // by patch, in PatchSet order
    std::vector<Level> levels;           // grouped by patch
    std::vector<std::uint32_t> patch_begin;  // size patches + 1, into levels
};
PatchLods simplify_patches(const IndexedMesh& mesh, const RenderVertices& vertices, const PatchSet& patches,
                           const SimplifyOptions& options, const Progress& progress = {});

}  // namespace splice
