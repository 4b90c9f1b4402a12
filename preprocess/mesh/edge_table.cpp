#include "preprocess/mesh/edge_table.h"

#include <algorithm>
#include <utility>

namespace splice {

EdgeTable build_edge_table(std::span<const Triangle> triangles, std::size_t vertices) {
    // Counting sort by the lower vertex, then a sort of each short bucket by the higher one.
    // An entry is (higher vertex, half-edge) in one word.
    using Entry = std::uint64_t;
    const auto ends = [&](std::size_t t, std::size_t k) {
        return std::minmax(triangles[t][k], triangles[t][k == 2 ? 0 : k + 1]);
    };
    std::vector<std::uint32_t> bucket(vertices + 1, 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k)
            ++bucket[std::pair(ends(t, k)).first + std::size_t{1}];
    }
    for (std::size_t v = 0; v < vertices; ++v)
        bucket[v + 1] += bucket[v];
    std::vector<Entry> entries(3 * triangles.size());
    std::vector<std::uint32_t> cursor(bucket.begin(), bucket.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::pair<std::uint32_t, std::uint32_t> e = ends(t, k);
            entries[cursor[e.first]++] = Entry{e.second} << 32 | (3 * t + k);
        }
    }
    EdgeTable table;
    table.half_edges.reserve(entries.size());
    table.edge_begin.reserve(entries.size() / 2 + 1);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::sort(entries.begin() + bucket[v], entries.begin() + bucket[v + 1]);
        for (std::uint32_t i = bucket[v]; i < bucket[v + 1]; ++i) {
            if (i == bucket[v] || entries[i] >> 32 != entries[i - 1] >> 32) table.edge_begin.push_back(i);
            table.half_edges.push_back(static_cast<std::uint32_t>(entries[i]));
        }
    }
    table.edge_begin.push_back(static_cast<std::uint32_t>(entries.size()));
    return table;
}

}  // namespace splice
