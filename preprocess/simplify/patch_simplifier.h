// Levels of detail of one patch by half-edge collapse: a vertex is moved onto a neighbour, so levels share the finest
// level's vertices and need indices only.
//
// Ni 3.2.4 keeps borders by adding the quadric of a plane perpendicular to the surface through each border edge
// (Garland's boundary constraint), which makes moving a border expensive but not impossible: neighbours at different
// levels could still crack. Here border vertices are locked outright, which needs no penalty plane and is exact.
#pragma once

#include "preprocess/simplify/plane_quadric.h"
#include "preprocess/simplify/simplify_patches.h"

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace splice {

/// One for each thread: its arrays are reused from patch to patch.
class PatchSimplifier {
  public:
    /// `on_border` has one entry a position: nonzero where triangles of several patches meet.
    PatchSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices, std::span<const std::uint8_t> on_border);

    struct CoarserLevels {
        std::vector<std::uint32_t> indices;    // into RenderVertices::vertices
        std::vector<PatchLods::Level> levels;  // first_index into `indices`; the finest level is not among them
    };
    CoarserLevels simplify(std::span<const std::uint32_t> triangles, const SimplifyOptions& options);

  private:
    using Index = std::uint32_t;
    static constexpr Index kNone = 0xffffffffu;

    // A vertex's cheapest collapse when it was pushed; stale when the version has moved on.
    struct Candidate {
        double cost;
        Index vertex, target;
        std::uint32_t version;
        bool legal;  // the target has been checked
    };
    struct Target {
        double cost;
        Index vertex;
    };

    static bool goes_later(const Candidate& a, const Candidate& b);
    void load(std::span<const std::uint32_t> triangles);
    void load_triangle(std::uint32_t triangle);
    void lock_seams_and_borders();
    bool is_interior(Index vertex) const;
    void collapse_until(std::size_t triangle_count);
    void push_candidate(Index vertex);
    void take(const Candidate& candidate);
    void list_targets(Index vertex);
    double cost(Index vertex, Index target) const;
    bool is_legal(Index vertex, Index target);
    bool link_is_simple(Index vertex, Index target);
    bool turns_no_triangle(Index vertex, Index target) const;
    void collapse(Index vertex, Index target);
    void drop_dead_corners(Index vertex);
    CoarserLevels choose_levels(const CoarserLevels& ladder, std::size_t finest, const SimplifyOptions& options) const;
    void append_level(CoarserLevels& result) const;

    Index next_in_triangle(Index corner) const { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    Index after(Index corner) const { return corner_vertex_[next_in_triangle(corner)]; }
    Index before(Index corner) const { return corner_vertex_[next_in_triangle(next_in_triangle(corner))]; }

    template <typename Visitor>
    void for_each_corner(Index vertex, const Visitor& visit) const {
        for (Index corner = first_corner_[vertex]; corner != kNone; corner = next_corner_[corner])
            visit(corner);
    }

    const IndexedMesh& mesh_;
    const RenderVertices& render_;
    std::span<const std::uint8_t> on_border_;

    std::vector<Index> local_of_position_;  // kNone outside the current patch

    // One entry a corner; corner / 3 is the triangle.
    std::vector<Index> corner_vertex_, corner_render_, next_corner_;
    std::vector<std::uint8_t> alive_;  // one a triangle
    std::size_t alive_count_ = 0;

    // One entry a local vertex.
    std::vector<Vec3d> position_, normal_;
    std::vector<Index> mesh_position_, first_corner_, degree_, version_, mark_;
    std::vector<std::uint8_t> locked_;
    std::vector<PlaneQuadric> quadric_;

    std::vector<Candidate> heap_;
    std::vector<Target> targets_;
    std::vector<Index> ring_;
    Index current_mark_ = 0;
    double error_ = 0;  // largest RMS distance of any collapse so far
};

}  // namespace splice
