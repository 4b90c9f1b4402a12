// Triangles that half-edge collapses take away one edge at a time: each vertex knows its corners. What the simplifiers
// of patches and of regions have in common.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace splice {

class CollapseMesh {
  protected:
    using Index = std::uint32_t;
    static constexpr Index kNone = 0xffffffffu;

    // Vertices with more triangles are neither moved nor moved onto, which bounds the work of a collapse.
    static constexpr Index kMaxDegree = 128;

    // The triangles on an edge, as seen from the vertex that is to move.
    struct EdgeTriangles {
        Index tips[2] = {kNone, kNone};    // third vertices
        Index render[2] = {kNone, kNone};  // of the target, in each
        bool simple = true;                // at most one on either side
        Index count() const { return (tips[0] != kNone ? 1u : 0u) + (tips[1] != kNone ? 1u : 0u); }
    };

    /// `positions`: how many the mesh has that parts are of.
    explicit CollapseMesh(std::size_t positions) : local_of_position_(positions, kNone) {}
    ~CollapseMesh() = default;

    void begin(std::size_t triangles);
    /// The next corner of the triangles, at a position of the mesh; returns its local vertex.
    Index add_corner(const IndexedMesh& mesh, Index mesh_position, Index render);
    /// Of the last three corners: twice its area along its normal, which is added to its vertices'.
    Vec3d add_normal();
    /// When there are no more corners to add.
    void end_load();
    /// Forgets which vertices were loaded.
    void forget();

    /// The triangles around a vertex form one consistently oriented fan from `start` to `end`, its neighbours; closed
    /// where those are the same.
    bool is_fan(Index vertex, Index start, Index end) const;

    /// Also marks the vertex's neighbours, for shares_only_tips().
    EdgeTriangles triangles_on_edge(Index vertex, Index target);
    /// The neighbours that both ends share are exactly the tips, and no triangle joins the tips to the target already;
    /// else the collapse would pinch the surface or fold it onto itself (Dey et al. 1999).
    bool shares_only_tips(Index target, const EdgeTriangles& edge);

    void drop_triangles_on_edge(Index vertex, Index target);
    /// All corners of `vertex` become the target's, its first ones.
    void move_corners(Index vertex, Index target, Index render);
    void drop_dead_corners(Index vertex);
    /// Appends to ring_ those neighbours that are not in it.
    void add_ring(Index vertex);

    Index next_in_triangle(Index corner) const { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    Index after(Index corner) const { return corner_vertex_[next_in_triangle(corner)]; }
    Index before(Index corner) const { return corner_vertex_[next_in_triangle(next_in_triangle(corner))]; }
    template <typename Visitor>
    void for_each_corner(Index vertex, const Visitor& visit) const {
        for (Index corner = first_corner_[vertex]; corner != kNone; corner = next_corner_[corner])
            visit(corner);
    }

    std::vector<Index> local_of_position_;  // kNone outside the current part

    // One entry a corner; corner / 3 is the triangle.
    std::vector<Index> corner_vertex_, corner_render_, next_corner_;
    std::vector<std::uint8_t> alive_;  // one a triangle
    std::size_t alive_count_ = 0;

    // One entry a local vertex.
    std::vector<Vec3d> position_, normal_;
    std::vector<Index> mesh_position_, first_corner_, degree_, mark_;

    std::vector<Index> ring_;
    Index current_mark_ = 0;
};

}  // namespace splice
