// A patch cut into small flat cells that are the unit of coverage: each cell lies whole inside one triangle and inside
// a ball (centre, margin). A disk whose tangential distance to the centre is at most its radius minus the margin covers
// the whole cell, because projection to the disk's plane shortens no more than it keeps: that is what makes a cover of
// all cells a cover of every point of the patch.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace splice {

/// Neighbouring cells of one triangle; flat, so they share a normal.
struct CellChunk {
    std::uint32_t first, count;   // cells
    std::uint32_t triangle;       // of the mesh
    float spacing;                // wanted distance between surfels here
    Vec3f normal;                 // of the triangle, unit, on the side of its corner normals
    std::array<Vec3f, 3> corner;  // of the part of the triangle that the cells tile, the longest edge first
    float cell_size;
};

class CoverCells {
  public:
    using Spacing = std::function<float(std::uint32_t triangle, const Vec3f& point)>;

    /// Cells have sides of about `relative_size` times the spacing, or are whole triangles where those are smaller.
    CoverCells(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, const Spacing& spacing,
               float relative_size);

    std::size_t size() const { return x.size(); }
    Vec3f centre(std::size_t cell) const { return {x[cell], y[cell], z[cell]}; }

    /// Calls visit(chunk) for every chunk whose box meets the ball.
    template <typename Visit>
    void for_each_chunk_near(const Vec3f& ball_centre, float ball_radius, Visit&& visit) const;

    /// Calls visit(cell, corners) for the cells of a chunk: the four corners whose convex hull is the cell.
    template <typename Visit>
    static void for_each_cell(const CellChunk& chunk, Visit&& visit);

    // Cells, one entry each, chunk by chunk. Centres lie on the surface.
    std::vector<float> x, y, z;
    std::vector<float> margin;  // radius of the ball around the centre that holds the cell
    std::vector<float> area;
    std::vector<std::uint32_t> chunk_of;
    std::vector<CellChunk> chunks;  // in Morton order

  private:
    struct Box {
        Vec3f low, high;
    };
    void cut_triangle(const IndexedMesh& mesh, std::uint32_t triangle, const Spacing& spacing, float relative_size);
    void sort_chunks();
    void add_cells();
    void build_tree();

    static constexpr std::size_t kBranching = 4;
    std::vector<std::vector<Box>>
        levels_;  // [0]: one a chunk; box i of a level bounds boxes 4 i .. 4 i + 3 of the one before
};

template <typename Visit>
void CoverCells::for_each_chunk_near(const Vec3f& ball_centre, float ball_radius, Visit&& visit) const {
    if (chunks.empty()) return;
    const float limit = ball_radius * ball_radius;
    const auto near = [&](const Box& box) {
        const Vec3f d = (box.low - ball_centre).cwiseMax(ball_centre - box.high).cwiseMax(0.0f);
        return d.squaredNorm() <= limit;
    };
    const auto descend = [&](auto&& self, std::size_t level, std::size_t node) -> void {
        if (!near(levels_[level][node])) return;
        if (level == 0) {
            visit(chunks[node]);
            return;
        }
        const std::size_t end = std::min((node + 1) * kBranching, levels_[level - 1].size());
        for (std::size_t child = node * kBranching; child < end; ++child)
            self(self, level - 1, child);
    };
    descend(descend, levels_.size() - 1, 0);
}

template <typename Visit>
void CoverCells::for_each_cell(const CellChunk& chunk, Visit&& visit) {
    // Rows parallel to the longest edge, which is the base; rows and base share a frame (u, v) at the first corner.
    const auto& [origin, base_end, apex_corner] = chunk.corner;
    const Vec3f base = base_end - origin, apex = apex_corner - origin;
    const float length = base.norm();
    const Vec3f u = length > 0 ? Vec3f(base / length) : Vec3f::Zero();
    const float apex_x = apex.dot(u);
    const Vec3f up = apex - apex_x * u;
    const int rows = std::max(1, static_cast<int>(std::ceil(up.norm() / chunk.cell_size)));
    std::uint32_t cell = chunk.first;
    for (int row = 0; row < rows; ++row) {
        const float f0 = static_cast<float>(row) / static_cast<float>(rows);
        const float f1 = static_cast<float>(row + 1) / static_cast<float>(rows);
        const Vec3f low = origin + f0 * apex, high = origin + f1 * apex;
        const Vec3f low_side = (1 - f0) * base, high_side = (1 - f1) * base;
        const float middle = (1 - (f0 + f1) / 2) * length;
        const int columns = std::max(1, static_cast<int>(std::ceil(middle / chunk.cell_size)));
        for (int column = 0; column < columns; ++column, ++cell) {
            const float g0 = static_cast<float>(column) / static_cast<float>(columns);
            const float g1 = static_cast<float>(column + 1) / static_cast<float>(columns);
            visit(cell, std::array<Vec3f, 4>{low + g0 * low_side, low + g1 * low_side, high + g0 * high_side,
                                             high + g1 * high_side});
        }
    }
}

}  // namespace splice
