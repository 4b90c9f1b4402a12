// Levels of detail of one patch by half-edge collapse: a vertex is moved onto a neighbour, so levels share the finest
// level's vertices and need indices only.
//
// Ni 3.2.4 keeps borders by adding the quadric of a plane perpendicular to the surface through each border edge
// (Garland's boundary constraint), which makes moving a border expensive but not impossible: neighbours at different
// levels could still crack. Here border vertices are locked outright, which needs no penalty plane and is exact.
#pragma once

#include "preprocess/simplify/collapse_queue.h"
#include "preprocess/simplify/plane_quadric.h"
#include "preprocess/simplify/simplify_patches.h"

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace splice {

/// One for each thread: its arrays are reused from patch to patch.
class PatchSimplifier : private CollapseQueue<PatchSimplifier> {
  public:
    /// `on_border` has one entry a position: nonzero where triangles of several patches meet.
    PatchSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices, std::span<const std::uint8_t> on_border);

    struct CoarserLevels {
        std::vector<std::uint32_t> indices;    // into RenderVertices::vertices
        std::vector<PatchLods::Level> levels;  // first_index into `indices`; the finest level is not among them
    };
    CoarserLevels simplify(std::span<const std::uint32_t> triangles, const SimplifyOptions& options);

  private:
    friend CollapseQueue;

    void load(std::span<const std::uint32_t> triangles);
    void load_triangle(std::uint32_t triangle);
    void lock_seams_and_borders();
    bool may_move(Index vertex) const { return !locked_[vertex]; }
    void list_targets(Index vertex);
    double cost(Index vertex, Index target) const;
    bool is_legal(Index vertex, Index target);
    bool link_is_simple(Index vertex, Index target);
    bool turns_no_triangle(Index vertex, Index target) const;
    void collapse(Index vertex, Index target);
    CoarserLevels choose_levels(const CoarserLevels& ladder, std::size_t finest, const SimplifyOptions& options) const;
    void append_level(CoarserLevels& result) const;

    const IndexedMesh& mesh_;
    const RenderVertices& render_;
    std::span<const std::uint8_t> on_border_;

    // One entry a local vertex.
    std::vector<std::uint8_t> locked_;
    std::vector<PlaneQuadric> quadric_;
    double error_ = 0;  // largest RMS distance of any collapse so far
};

}  // namespace splice
