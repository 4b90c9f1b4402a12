#include "preprocess/mesh/halfedge.h"

#include <algorithm>
#include <tuple>

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

/// OpenMesh prints every face it refuses. Refusals are expected here and handled.
class QuietOpenMesh {
  public:
    QuietOpenMesh() : was_enabled_(omerr().is_enabled()) { omerr().disable(); }
    ~QuietOpenMesh() {
        if (was_enabled_) omerr().enable();
    }
    QuietOpenMesh(const QuietOpenMesh&) = delete;
    QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;

  private:
    bool was_enabled_;
};

struct OpenEdge {
    std::uint32_t vertex[2];  // ascending
    std::uint32_t face;
    std::pair<std::uint32_t, std::uint32_t> ends() const { return {vertex[0], vertex[1]}; }
};

/// The half-edge mesh in an order of its own: face i is face order[i] of the source, vertex i is vertex_source[i].
struct Insertion {
    HalfedgeMesh halfedges;
    std::vector<std::uint32_t> vertex_source;
    std::uint64_t detached_faces = 0;
};

Insertion insert_faces(const IndexedMesh& mesh, std::span<const std::uint32_t> order) {
    const QuietOpenMesh quiet;
    Insertion result;
    HalfedgeMesh& halfedges = result.halfedges;
    halfedges.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2 + 3, mesh.triangles.size());
    const auto new_vertex = [&](std::uint32_t source) {
        result.vertex_source.push_back(source);
        return halfedges.new_vertex();
    };
    std::vector<OpenMesh::VertexHandle> vertex_of(mesh.positions.size());
    for (const std::uint32_t f : order) {
        const Triangle& t = mesh.triangles[f];
        for (const std::uint32_t v : t) {
            if (!vertex_of[v].is_valid()) vertex_of[v] = new_vertex(v);
        }
        if (halfedges.add_face(vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]).is_valid()) continue;
        ++result.detached_faces;
        const auto a = new_vertex(t[0]), b = new_vertex(t[1]), c = new_vertex(t[2]);
        halfedges.add_face(a, b, c);
    }
    return result;
}

}  // namespace

FaceAdjacency find_face_adjacency(const IndexedMesh& mesh, std::span<const std::uint32_t> order) {
    const Insertion inserted = insert_faces(mesh, order);
    const HalfedgeMesh& halfedges = inserted.halfedges;
    const auto source_vertex = [&](OpenMesh::VertexHandle v) {
        return inserted.vertex_source[static_cast<std::size_t>(v.idx())];
    };
    const auto source_face = [&](OpenMesh::FaceHandle f) { return order[static_cast<std::size_t>(f.idx())]; };

    FaceAdjacency result;
    result.detached_faces = inserted.detached_faces;
    result.pairs.reserve(halfedges.n_edges());
    std::vector<OpenEdge> open;
    for (std::size_t e = 0; e < halfedges.n_edges(); ++e) {
        const auto h = halfedges.halfedge_handle(OpenMesh::EdgeHandle(static_cast<int>(e)), 0);
        std::uint32_t v0 = source_vertex(halfedges.from_vertex_handle(h));
        std::uint32_t v1 = source_vertex(halfedges.to_vertex_handle(h));
        if (v0 > v1) std::swap(v0, v1);
        const auto f0 = halfedges.face_handle(h), f1 = halfedges.face_handle(halfedges.opposite_halfedge_handle(h));
        if (f0.is_valid() && f1.is_valid()) {
            const std::uint32_t a = source_face(f0), b = source_face(f1);
            result.pairs.push_back({{std::min(a, b), std::max(a, b)}, {v0, v1}});
        } else {
            open.push_back({{v0, v1}, source_face(f0.is_valid() ? f0 : f1)});
        }
    }

    std::sort(open.begin(), open.end(), [](const OpenEdge& a, const OpenEdge& b) {
        return std::tuple(a.ends(), a.face) < std::tuple(b.ends(), b.face);
    });
    const auto find_open = [&](std::pair<std::uint32_t, std::uint32_t> ends) {
        return std::lower_bound(open.begin(), open.end(), ends,
                                [](const OpenEdge& a, const auto& key) { return a.ends() < key; });
    };

    // A paired edge that also occurs among the open ones has three or more faces: take the pair back.
    std::vector<bool> touches_open(mesh.positions.size(), false);
    for (const OpenEdge& e : open)
        touches_open[e.vertex[0]] = touches_open[e.vertex[1]] = true;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> crowded;
    std::erase_if(result.pairs, [&](const FacePair& p) {
        if (!touches_open[p.vertex[0]] || !touches_open[p.vertex[1]]) return false;
        const std::pair ends{p.vertex[0], p.vertex[1]};
        const auto found = find_open(ends);
        if (found == open.end() || found->ends() != ends) return false;
        crowded.push_back(ends);
        return true;
    });
    std::sort(crowded.begin(), crowded.end());

    for (auto first = open.begin(); first != open.end();) {
        const auto last = std::find_if(first, open.end(), [&](const OpenEdge& e) { return e.ends() != first->ends(); });
        if (last - first == 2 && !std::binary_search(crowded.begin(), crowded.end(), first->ends())) {
            result.pairs.push_back({{first->face, (first + 1)->face}, {first->vertex[0], first->vertex[1]}});
        }
        first = last;
    }
    return result;
}

}  // namespace splice
