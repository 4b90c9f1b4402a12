// What RegionSimplifier leaves of a whole mesh.
#pragma once

#include "preprocess/simplify/region_simplifier.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice::test {

struct Simplified {
    IndexedMesh mesh;
    std::vector<std::uint8_t> shared = std::vector<std::uint8_t>(mesh.positions.size(), 0);
    RenderVertices render = build_render_vertices(mesh);

    std::vector<RegionLevel> levels(std::span<const double> shares, bool keep_topology = true) {
        RegionTriangles all;
        all.corners = render.indices;
        return RegionSimplifier(mesh, render, shared).simplify(all, shares, keep_topology);
    }
    const format::Vertex& vertex(const RegionLevel& level, std::uint32_t corner) const {
        return corner < render.vertices.size() ? render.vertices[corner]
                                               : level.triangles.vertices[corner - render.vertices.size()];
    }
    std::uint32_t position(const RegionLevel& level, std::uint32_t corner) const {
        return corner < render.vertices.size() ? render.position[corner]
                                               : level.triangles.position[corner - render.vertices.size()];
    }
    /// Three a triangle, by position: what touches there is one vertex, whatever its normals.
    std::vector<std::uint32_t> positions(const RegionLevel& level) const {
        std::vector<std::uint32_t> result;
        for (const std::uint32_t corner : level.triangles.corners)
            result.push_back(position(level, corner));
        return result;
    }
};

}  // namespace splice::test
