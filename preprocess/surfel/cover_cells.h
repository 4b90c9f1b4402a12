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

/// Cosine of the largest angle between the normals of a disk and of a cell that it covers.
inline constexpr float kLeastAgreement = 0.5f;

class CoverCells {
  public:
    using Spacing = std::function<float(std::uint32_t triangle, const Vec3f& point)>;

    /// Cells have sides of about `relative_size` times the spacing, or are whole triangles where those are smaller.
    CoverCells(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, const Spacing& spacing,
               float relative_size);

    std::size_t size() const { return x.size(); }
    Vec3f centre(std::size_t cell) const { return {x[cell], y[cell], z[cell]}; }

    /// Calls visit(first, end) for ranges of cells that hold at least all cells within the ball whose normal is at most
    /// 60 degrees from `normal` (kLeastAgreement), and no cell that disagrees more.
    template <typename Visit>
    void for_each_range_near(const Vec3f& ball_centre, float ball_radius, const Vec3f& normal, Visit&& visit) const;

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
    // How many cells the side of a cell may lean over, as the triangle's sides do: those of a sliver lean as far as it
    // is long.
    static constexpr float kMostSlant = 2.0f;
    static constexpr std::size_t kBranching = 4;
    // The bounding boxes of a node's children side by side, so that one pass of vector instructions tests them all;
    // boxes of absent children are inside out.
    struct Node {
        float low[3][kBranching], high[3][kBranching];
    };
    // Chunks in a row, so that the search ends at runs of cells long enough to be worth it.
    struct Group {
        std::uint32_t first_chunk, end_chunk, first_cell, end_cell;
        Vec3f axis;  // of a cone that holds the chunks' normals
        float cosine, sine;
    };
    void cut_triangle(const IndexedMesh& mesh, std::uint32_t triangle, const Spacing& spacing, float relative_size);
    void sort_chunks();
    void add_cells();
    void group_chunks();
    void build_tree();

    std::vector<Group> groups_;
    std::vector<std::vector<Node>> levels_;  // children of node i: groups or nodes of the level before, 4 i .. 4 i + 3
};

template <typename Visit>
void CoverCells::for_each_range_near(const Vec3f& ball_centre, float ball_radius, const Vec3f& normal,
                                     Visit&& visit) const {
    const float limit = ball_radius * ball_radius;
    const auto visit_group = [&](const Group& group) {
        // Cosines of the smallest and of the largest angle between `normal` and the cone.
        const float cosine = group.axis.dot(normal), sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
        const float farthest = cosine * group.cosine - sine * group.sine;
        if (cosine + group.cosine > 0 && farthest >= kLeastAgreement + 1e-5f) {
            visit(group.first_cell, group.end_cell);
            return;
        }
        for (auto c = group.first_chunk; c < group.end_chunk; ++c) {
            if (chunks[c].normal.dot(normal) >= kLeastAgreement)
                visit(chunks[c].first, chunks[c].first + chunks[c].count);
        }
    };
    const auto descend = [&](auto&& self, std::size_t level, std::size_t index) -> void {
        const Node& node = levels_[level][index];
        float distance2[kBranching] = {};
        for (int axis = 0; axis < 3; ++axis) {
            const float c = ball_centre[axis];
            for (std::size_t k = 0; k < kBranching; ++k) {
                const float d = std::max(std::max(node.low[axis][k] - c, c - node.high[axis][k]), 0.0f);
                distance2[k] += d * d;
            }
        }
        for (std::size_t k = 0; k < kBranching; ++k) {
            if (!(distance2[k] <= limit)) continue;
            if (level == 0) {
                visit_group(groups_[index * kBranching + k]);
            } else {
                self(self, level - 1, index * kBranching + k);
            }
        }
    };
    if (!levels_.empty()) descend(descend, levels_.size() - 1, 0);
}

template <typename Visit>
void CoverCells::for_each_cell(const CellChunk& chunk, Visit&& visit) {
    // Rows parallel to the longest edge, which is the base; rows and base share a frame (u, v) at the first corner.
    const auto& [origin, base_end, apex_corner] = chunk.corner;
    const Vec3f base = base_end - origin, apex = apex_corner - origin;
    const float length = base.norm();
    const Vec3f u = length > 0 ? Vec3f(base / length) : Vec3f::Zero();
    const float apex_x = apex.dot(u);
    const Vec3f foot = apex_x * u;
    const int rows = std::max(1, static_cast<int>(std::ceil((apex - foot).norm() / chunk.cell_size)));
    const float row_height = 1 / static_cast<float>(rows);
    const bool slanted = std::max(apex_x, length - apex_x) * row_height > kMostSlant * chunk.cell_size;

    std::uint32_t cell = chunk.first;
    const auto cut = [&](const Vec3f& low, const Vec3f& low_side, const Vec3f& high, const Vec3f& high_side,
                         float width) {
        const int columns = static_cast<int>(std::ceil(width / chunk.cell_size));
        for (int column = 0; column < columns; ++column, ++cell) {
            const float g0 = static_cast<float>(column) / static_cast<float>(columns);
            const float g1 = static_cast<float>(column + 1) / static_cast<float>(columns);
            visit(cell, std::array<Vec3f, 4>{low + g0 * low_side, low + g1 * low_side, high + g0 * high_side,
                                             high + g1 * high_side});
        }
    };
    for (int row = 0; row < rows; ++row) {
        const float f0 = static_cast<float>(row) / static_cast<float>(rows);
        const float f1 = static_cast<float>(row + 1) / static_cast<float>(rows);
        const Vec3f low = origin + f0 * apex, high = origin + f1 * apex;
        const Vec3f low_side = (1 - f0) * base, high_side = (1 - f1) * base;
        if (!slanted) {
            cut(low, low_side, high, high_side, std::max((1 - (f0 + f1) / 2) * length, chunk.cell_size));
            continue;
        }
        // What rises, what is level and what falls, each cut across.
        const Vec3f rise = row_height * foot, fall = row_height * (base - foot);
        cut(low, rise, low, row_height * apex, row_height * apex_x);
        cut(low + rise, high_side, high, high_side, (1 - f1) * length);
        cut(low + rise + high_side, fall, high + high_side, row_height * (base - apex), row_height * (length - apex_x));
    }
}

}  // namespace splice
