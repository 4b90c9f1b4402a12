#include "preprocess/cluster/face_graph.h"

#include "preprocess/cluster/radix_sort.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace splice {
namespace {

/// The low 10 bits of x, two zero bits after each.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

std::uint32_t morton_code(const Vec3f& p) {
    const auto cell = [](float x) {
        return static_cast<std::uint32_t>(std::clamp((x + 0.5f) * 1024.0f, 0.0f, 1023.0f));  // unit box at the origin
    };
    return spread_bits(cell(p.x())) | (spread_bits(cell(p.y())) << 1) | (spread_bits(cell(p.z())) << 2);
}

/// Links in ascending order without sorting: each slot has at most three, and a counting pass places them.
std::vector<FaceGraph::Link> place_links(const std::vector<FaceGraph::Link>& links, std::size_t slots) {
    std::vector<std::uint64_t> begin(slots + 1, 0);
    for (const FaceGraph::Link& l : links)
        ++begin[l.slot[0] + 1];
    for (std::size_t s = 0; s < slots; ++s)
        begin[s + 1] += begin[s];
    std::vector<FaceGraph::Link> placed(links.size());
    std::vector<std::uint64_t> next(begin.begin(), begin.end() - 1);
    for (const FaceGraph::Link& l : links)
        placed[next[l.slot[0]]++] = l;
    tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t s) {
        std::sort(placed.begin() + static_cast<std::ptrdiff_t>(begin[s]),
                  placed.begin() + static_cast<std::ptrdiff_t>(begin[s + 1]),
                  [](const FaceGraph::Link& a, const FaceGraph::Link& b) { return a.slot[1] < b.slot[1]; });
    });
    return placed;
}

}  // namespace

std::vector<std::uint32_t> order_faces(const IndexedMesh& mesh) {
    std::vector<std::uint64_t> keys(mesh.triangles.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3f centroid = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0f;
        keys[f] = (std::uint64_t{morton_code(centroid)} << 32) | f;
    });
    radix_sort_by_high_half(keys);
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(),
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return order;
}

FaceGraph measure_faces(const IndexedMesh& mesh, std::vector<std::uint32_t> order) {
    FaceGraph graph;
    graph.face_of_slot = std::move(order);
    const std::size_t faces = mesh.triangles.size();
    graph.area.resize(faces);
    graph.perimeter.resize(faces);
    graph.normal.resize(faces);
    tbb::parallel_for(std::size_t{0}, faces, [&](std::size_t s) {
        const auto [a, b, c] = graph.corners(mesh, s);
        // Double: the cross product of a sliver cancels in float.
        const Vec3d twice_area = (b - a).cast<double>().cross((c - a).cast<double>());
        const double length = twice_area.norm();
        graph.area[s] = static_cast<float>(length / 2);
        graph.perimeter[s] = (b - a).norm() + (c - b).norm() + (a - c).norm();
        graph.normal[s] = length > 0 ? Vec3f((twice_area / length).cast<float>()) : Vec3f(Vec3f::UnitZ());
    });
    return graph;
}

std::vector<FaceGraph::Link> link_faces(const IndexedMesh& mesh, std::span<const std::uint32_t> face_of_slot,
                                        const FaceAdjacency& adjacency) {
    std::vector<std::uint32_t> slot_of_face(face_of_slot.size());
    for (std::uint32_t s = 0; s < face_of_slot.size(); ++s)
        slot_of_face[face_of_slot[s]] = s;
    std::vector<FaceGraph::Link> links;
    links.reserve(adjacency.pairs.size());
    for (const FacePair& pair : adjacency.pairs) {
        const std::uint32_t f0 = pair.face[0], f1 = pair.face[1];
        if (!mesh.triangle_material.empty() && mesh.triangle_material[f0] != mesh.triangle_material[f1]) continue;
        const float length = (mesh.positions[pair.vertex[0]] - mesh.positions[pair.vertex[1]]).norm();
        const std::uint32_t s0 = slot_of_face[f0], s1 = slot_of_face[f1];
        links.push_back({{std::min(s0, s1), std::max(s0, s1)}, length});
    }
    return place_links(links, face_of_slot.size());
}

}  // namespace splice
