// Edges of a level of detail by its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace splice::test {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // render vertices, in the direction of the triangle

inline std::map<Edge, int> directed_edges(std::span<const std::uint32_t> indices) {
    std::map<Edge, int> edges;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++edges[{indices[i + k], indices[i + (k + 1) % 3]}];
    return edges;
}

/// Those without a partner in the opposite direction: the border of a level, and its attribute seams.
inline std::set<Edge> open_edges(std::span<const std::uint32_t> indices) {
    const auto edges = directed_edges(indices);
    std::set<Edge> open;
    for (const auto& [edge, count] : edges)
        if (!edges.contains({edge.second, edge.first})) open.insert(edge);
    return open;
}

}  // namespace splice::test
