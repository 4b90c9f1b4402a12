// Coarser triangles of a connected part of a mesh, by half-edge collapse, with vertices of their own: each has the
// normal and colour that suit all it stands for best, so that levels are filtered as they get coarser. Only what the
// part shares with others is locked; open borders move along themselves.
#pragma once

#include "preprocess/simplify/attribute_quadric.h"
#include "preprocess/simplify/collapse_queue.h"
#include "preprocess/simplify/simplify_patches.h"

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace splice {

/// Triangles with vertices beside RenderVertices::vertices: index i of them is meant by that one's size + i.
struct RegionTriangles {
    std::vector<std::uint32_t> corners;  // three a triangle
    std::vector<format::Vertex> vertices;
    std::vector<std::uint32_t> position;  // IndexedMesh position of each of these
};

struct RegionLevel {
    RegionTriangles triangles;
    // Unit-box units: the root mean square of distances over the surface, or half of the largest if that is more; and
    // how far normals and colours differ from linear, times the width of what a vertex stands for.
    double shape_error = 0, looks_error = 0;
};

/// One for each thread: its arrays are reused.
class RegionSimplifier : private CollapseQueue<RegionSimplifier> {
  public:
    /// `shared` has one entry a position: nonzero where others have triangles, too. All three must outlive the
    /// simplifier.
    RegionSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices, std::span<const std::uint8_t> shared);

    /// One level for each of `shares`, descending, of the triangles that are to be left. Ends where locked vertices
    /// prevail, which leave only collapses of many times the error. Without `keep_topology`, handles may be pinched:
    /// the surface stays as closed as it was, but edges may have more than two triangles.
    std::vector<RegionLevel> simplify(const RegionTriangles& triangles, std::span<const double> shares,
                                      bool keep_topology = true);

  private:
    friend CollapseQueue;
    enum class Kind : std::uint8_t { kInner, kBorder, kLocked };
    using Attributes = AttributeQuadric::Attributes;

    // Edges with a triangle on one side only, at a vertex.
    struct OpenEdges {
        Index before = kNone, after = kNone;  // the vertices that they lead from and to
        Index count = 0;
    };

    void load(const RegionTriangles& triangles);
    std::vector<std::uint32_t> without_fins(std::span<const std::uint32_t> corners) const;
    void weigh_attributes();
    void add_quadrics();
    Kind kind_of(Index vertex);
    OpenEdges open_edges(Index vertex);
    bool is_seam(std::uint32_t a, std::uint32_t b) const;
    void collapse_until(std::size_t triangle_count);
    bool may_move(Index vertex) const { return kind_[vertex] != Kind::kLocked; }
    void list_targets(Index vertex);
    double cost(Index vertex, Index target) const;
    bool is_legal(Index vertex, Index target);
    bool link_is_simple(Index vertex, Index target);
    bool turns_no_triangle(Index vertex, Index target) const;
    void collapse(Index vertex, Index target);
    std::uint32_t suiting(Index corner, std::uint32_t render) const;
    void measure(RegionLevel& level) const;
    RegionLevel level() const;
    format::Vertex fitted_vertex(Index vertex) const;
    Attributes attributes_of(const format::Vertex& vertex) const;

    std::uint32_t first_own() const { return static_cast<std::uint32_t>(render_.vertices.size()); }
    const format::Vertex& vertex_at(std::uint32_t index) const {
        return index < first_own() ? render_.vertices[index] : own_->vertices[index - first_own()];
    }
    std::uint32_t position_at(std::uint32_t index) const {
        return index < first_own() ? render_.position[index] : own_->position[index - first_own()];
    }

    const IndexedMesh& mesh_;
    const RenderVertices& render_;
    std::span<const std::uint8_t> shared_;
    const RegionTriangles* own_ = nullptr;
    bool keep_topology_ = true;

    std::size_t attribute_count_ = 0;
    double width_ = 0;                                           // of what a vertex stands for
    double normal_worth_ = 0, colour_worth_ = 0, uv_worth_ = 0;  // as distances

    // One entry a local vertex.
    std::vector<Kind> kind_;
    std::vector<std::uint8_t> merged_;  // stands for more than itself
    std::vector<AttributeQuadric> quadric_;
    std::size_t free_ = 0, least_free_ = 0;  // vertices that are not locked; at how many to end
};

}  // namespace splice
