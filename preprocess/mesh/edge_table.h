// Which triangles meet at each edge, for meshes that need not be manifold.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Half-edge 3 * t + k runs from corner k to corner (k + 1) % 3 of triangle t.
struct EdgeTable {
    std::vector<std::uint32_t> half_edges;  // grouped by undirected edge, ascending inside a group
    std::vector<std::uint32_t> edge_begin;  // size edges + 1, into half_edges

    std::size_t size() const { return edge_begin.size() - 1; }
    std::span<const std::uint32_t> edge(std::size_t e) const {
        return {half_edges.data() + edge_begin[e], half_edges.data() + edge_begin[e + 1]};
    }
};

/// O(n) for bounded valence. Fewer than 2^32 / 3 triangles.
EdgeTable build_edge_table(std::span<const Triangle> triangles, std::size_t vertices);

/// True if two half-edges of one edge run the same way, which consistently oriented triangles never do.
inline bool same_direction(std::span<const Triangle> triangles, std::uint32_t h0, std::uint32_t h1) {
    return triangles[h0 / 3][h0 % 3] == triangles[h1 / 3][h1 % 3];
}

}  // namespace splice
