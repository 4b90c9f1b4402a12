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

OpenMesh::VertexHandle handle(std::size_t index) {
    return OpenMesh::VertexHandle(static_cast<int>(index));
}

struct OpenEdge {
    std::uint32_t vertex[2];  // ascending
    std::uint32_t face;
    std::pair<std::uint32_t, std::uint32_t> ends() const { return {vertex[0], vertex[1]}; }
};

/// The half-edge mesh and, because inserting may duplicate vertices, where its vertices come from. Face ids agree.
struct Insertion {
    HalfedgeMesh halfedges;
    std::vector<std::uint32_t> duplicate_of;  // source vertex of vertex positions.size() + i
    std::uint64_t detached_faces = 0;
};

Insertion insert_faces(const IndexedMesh& mesh) {
    const QuietOpenMesh quiet;
    Insertion result;
    HalfedgeMesh& halfedges = result.halfedges;
    halfedges.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2 + 3, mesh.triangles.size());
    halfedges.resize(mesh.positions.size(), 0, 0);
    for (const Triangle& t : mesh.triangles) {
        if (halfedges.add_face(handle(t[0]), handle(t[1]), handle(t[2])).is_valid()) continue;
        ++result.detached_faces;
        OpenMesh::VertexHandle own[3];
        for (int k = 0; k < 3; ++k) {
            own[k] = halfedges.new_vertex();
            result.duplicate_of.push_back(t[k]);
        }
        halfedges.add_face(own[0], own[1], own[2]);
    }
    return result;
}

}  // namespace

FaceAdjacency find_face_adjacency(const IndexedMesh& mesh) {
    const Insertion inserted = insert_faces(mesh);
    const HalfedgeMesh& halfedges = inserted.halfedges;
    const auto source_vertex = [&](OpenMesh::VertexHandle v) {
        const auto index = static_cast<std::size_t>(v.idx());
        return index < mesh.positions.size() ? static_cast<std::uint32_t>(index)
                                             : inserted.duplicate_of[index - mesh.positions.size()];
    };

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
        const auto id0 = static_cast<std::uint32_t>(f0.idx()), id1 = static_cast<std::uint32_t>(f1.idx());
        if (f0.is_valid() && f1.is_valid()) {
            result.pairs.push_back({{std::min(id0, id1), std::max(id0, id1)}, {v0, v1}});
        } else {
            open.push_back({{v0, v1}, f0.is_valid() ? id0 : id1});
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
