#include "preprocess/mesh/halfedge.h"

#include "preprocess/mesh/edge_table.h"

#include <algorithm>

// OpenMesh's headers are not free of the warnings that our own code is held to.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#pragma GCC diagnostic pop

namespace splice {
namespace {

/// Connectivity only: no status bits, no normals; 8 bytes a half-edge, 4 a face.
struct BareTraits : OpenMesh::DefaultTraits {
    VertexAttributes(0);
    HalfedgeAttributes(0);
    EdgeAttributes(0);
    FaceAttributes(0);
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<BareTraits>;

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr std::uint32_t kNone = 0xffffffffu;

int handle_index(std::size_t i) {
    return static_cast<int>(i);
}

std::uint32_t next_corner(std::uint32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}
std::uint32_t previous_corner(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}

/// The triangles in `order`, with their vertices numbered as they come up: what lies together is stored together.
struct LocalTriangles {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> vertex_source;  // IndexedMesh position

    LocalTriangles(const IndexedMesh& mesh, std::span<const std::uint32_t> order) : triangles(order.size()) {
        std::vector<std::uint32_t> local(mesh.positions.size(), kNone);
        vertex_source.reserve(mesh.positions.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = mesh.triangles[order[i]][k];
                if (local[v] == kNone) {
                    local[v] = static_cast<std::uint32_t>(vertex_source.size());
                    vertex_source.push_back(v);
                }
                triangles[i][k] = local[v];
            }
        }
    }
};

/// Builds the half-edge structure in bulk, from which corners meet at which edge. That takes a third of the time of
/// OpenMesh's add_face, which looks for each edge around its vertices. Corner h = 3 * face + k has the half-edge to the
/// next corner of its face.
class BulkBuilder {
  public:
    BulkBuilder(const LocalTriangles& local, const EdgeTable& edges)
        : local_(local), edges_(edges), corners_(3 * local.triangles.size()) {
        join_edges();
        place_vertices();
    }

    HalfedgeMesh build() const {
        HalfedgeMesh mesh;
        mesh.resize(vertices_, edge_corner_.size(), local_.triangles.size());
        for (std::uint32_t h = 0; h < corners_.size(); ++h) {
            const HalfedgeHandle half = corners_[h].half;
            const FaceHandle face(handle_index(h / 3));
            mesh.set_vertex_handle(half, VertexHandle(handle_index(corners_[next_corner(h)].vertex)));
            mesh.set_face_handle(half, face);
            mesh.set_next_halfedge_handle(half, corners_[next_corner(h)].half);
            if (h % 3 == 0) mesh.set_halfedge_handle(face, half);
            if (corners_[h].opposite != kNone) continue;
            mesh.set_vertex_handle(mesh.opposite_halfedge_handle(half), VertexHandle(handle_index(corners_[h].vertex)));
        }
        link_borders(mesh);
        return mesh;
    }
    /// By vertex of the structure: the IndexedMesh position.
    const std::vector<std::uint32_t>& vertex_source() const { return vertex_source_; }
    std::uint64_t torn_edges() const { return torn_edges_; }

  private:
    struct Corner {
        HalfedgeHandle half;
        std::uint32_t opposite = kNone;  // corner whose half-edge runs the other way along the same edge
        std::uint32_t vertex = kNone;    // of the half-edge structure
    };

    /// Edges that two faces use in opposite directions become one; of any other, each face has one of its own.
    void join_edges() {
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const auto meeting = edges_.edge(e);
            if (meeting.size() == 2 && !same_direction(local_.triangles, meeting[0], meeting[1])) {
                corners_[meeting[0]].opposite = meeting[1];
                corners_[meeting[1]].opposite = meeting[0];
                add_edge(meeting[0]);
                corners_[meeting[1]].half = HalfedgeHandle(corners_[meeting[0]].half.idx() + 1);
                continue;
            }
            if (meeting.size() > 1) ++torn_edges_;
            for (const std::uint32_t h : meeting)
                add_edge(h);
        }
    }
    void add_edge(std::uint32_t h) {
        corners_[h].half = HalfedgeHandle(handle_index(2 * edge_corner_.size()));
        edge_corner_.push_back(h);
    }

    /// Each fan of faces around a vertex gets a vertex of its own, as half-edge structures need.
    void place_vertices() {
        for (std::uint32_t h = 0; h < corners_.size(); ++h) {
            if (corners_[h].vertex != kNone) continue;
            std::uint32_t first = h;
            while (corners_[first].opposite != kNone) {
                first = next_corner(corners_[first].opposite);
                if (first == h) break;
            }
            vertex_source_.push_back(local_.vertex_source[local_.triangles[h / 3][h % 3]]);
            vertex_corner_.push_back(first);
            std::uint32_t at = first, incoming = kNone;
            do {
                corners_[at].vertex = vertices_;
                incoming = previous_corner(at);
                at = corners_[incoming].opposite;
            } while (at != kNone && at != first);
            if (at == kNone) border_turns_.push_back({first, incoming});
            ++vertices_;
        }
    }

    /// Borders run the other way than their faces: into the vertex beside its fan's first outgoing half-edge, and out
    /// of it beside the last incoming one.
    void link_borders(HalfedgeMesh& mesh) const {
        for (std::size_t v = 0; v < vertex_corner_.size(); ++v)
            mesh.set_halfedge_handle(VertexHandle(handle_index(v)), corners_[vertex_corner_[v]].half);
        for (const BorderTurn& turn : border_turns_) {
            const HalfedgeHandle out = mesh.opposite_halfedge_handle(corners_[turn.last_incoming].half);
            mesh.set_next_halfedge_handle(mesh.opposite_halfedge_handle(corners_[turn.first_outgoing].half), out);
            mesh.set_halfedge_handle(mesh.from_vertex_handle(out), out);
        }
    }

    struct BorderTurn {
        std::uint32_t first_outgoing, last_incoming;
    };

    const LocalTriangles& local_;
    const EdgeTable& edges_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> edge_corner_;    // by edge: the corner of its first half-edge
    std::vector<std::uint32_t> vertex_corner_;  // by vertex: a corner at it
    std::vector<std::uint32_t> vertex_source_;
    std::vector<BorderTurn> border_turns_;
    std::uint32_t vertices_ = 0;
    std::uint64_t torn_edges_ = 0;
};

}  // namespace

FaceAdjacency find_face_adjacency(const IndexedMesh& mesh, std::span<const std::uint32_t> order) {
    const LocalTriangles local(mesh, order);
    const EdgeTable edges = build_edge_table(local.triangles, local.vertex_source.size());
    const BulkBuilder builder(local, edges);
    const HalfedgeMesh halfedges = builder.build();

    FaceAdjacency result;
    result.torn_edges = builder.torn_edges();
    result.pairs.reserve(halfedges.n_edges());
    const auto add_pair = [&](std::size_t f0, std::size_t f1, std::uint32_t v0, std::uint32_t v1) {
        const auto [a, b] = std::minmax(order[f0], order[f1]);
        const auto [u, v] = std::minmax(v0, v1);
        result.pairs.push_back({{a, b}, {u, v}});
    };
    const auto source_vertex = [&](VertexHandle v) {
        return builder.vertex_source()[static_cast<std::size_t>(v.idx())];
    };
    for (std::size_t e = 0; e < halfedges.n_edges(); ++e) {
        const HalfedgeHandle h = halfedges.halfedge_handle(EdgeHandle(handle_index(e)), 0);
        const FaceHandle f0 = halfedges.face_handle(h),
                         f1 = halfedges.face_handle(halfedges.opposite_halfedge_handle(h));
        if (!f0.is_valid() || !f1.is_valid()) continue;
        add_pair(static_cast<std::size_t>(f0.idx()), static_cast<std::size_t>(f1.idx()),
                 source_vertex(halfedges.from_vertex_handle(h)), source_vertex(halfedges.to_vertex_handle(h)));
    }
    if (result.torn_edges == 0) return result;
    // What the structure tears apart because two faces run the same way along it.
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto meeting = edges.edge(e);
        if (meeting.size() != 2 || !same_direction(local.triangles, meeting[0], meeting[1])) continue;
        const Triangle& t = local.triangles[meeting[0] / 3];
        add_pair(meeting[0] / 3, meeting[1] / 3, local.vertex_source[t[meeting[0] % 3]],
                 local.vertex_source[t[next_corner(meeting[0]) % 3]]);
    }
    return result;
}

}  // namespace splice
