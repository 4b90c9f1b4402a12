// Triangles are bisected across their longest edge until a piece needs few cells; a piece is then cut into rows
// parallel to its longest edge and each row into trapezoids, so slivers get one row and nothing depends on the
// neighbours.
#include "preprocess/surfel/cover_cells.h"

#include "preprocess/surfel/morton.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splice {
namespace {

constexpr float kCellsPerChunk = 48;
// Rounding of centres and radii stays below this: positions are within the unit box, so a float's last bit is 6e-8.
constexpr float kRoundingSlack = 5e-7f;

using Corners = std::array<Vec3f, 3>;

int longest_edge(const Corners& p) {
    int longest = 0;
    float best = -1;
    for (int k = 0; k < 3; ++k) {
        const float length2 = (p[static_cast<std::size_t>((k + 1) % 3)] - p[static_cast<std::size_t>(k)]).squaredNorm();
        if (length2 > best) {
            best = length2;
            longest = k;
        }
    }
    return longest;
}

}  // namespace

struct CoverCells::Piece {
    Corners corner;  // the longest edge runs from the first to the second
    std::uint32_t triangle;
    float spacing;
    Vec3f normal;
    std::uint32_t morton;
};

CoverCells::CoverCells(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, const Spacing& spacing,
                       float relative_size) {
    std::vector<Piece> pieces;
    pieces.reserve(triangles.size());
    std::vector<Corners> pending;
    for (const auto t : triangles) {
        const auto& v = mesh.triangles[t];
        const Vec3f* n = &mesh.corner_normals[3 * std::size_t{t}];
        pending.push_back({mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]});
        Vec3f normal = (pending[0][1] - pending[0][0]).cross(pending[0][2] - pending[0][0]).normalized();
        if (!normal.allFinite() || normal.squaredNorm() < 0.5f) normal = n[0];
        if (normal.dot(n[0] + n[1] + n[2]) < 0) normal = -normal;
        while (!pending.empty()) {
            Corners p = pending.back();
            pending.pop_back();
            const int k = longest_edge(p);
            std::rotate(p.begin(), p.begin() + k, p.end());
            const Vec3f centroid = (p[0] + p[1] + p[2]) / 3;
            const float here = spacing(t, centroid);
            const float longest = (p[1] - p[0]).norm();
            const float height = (p[1] - p[0]).cross(p[2] - p[0]).norm() / std::max(longest, 1e-30f);
            float least = here;
            for (const auto& corner : p)
                least = std::min(least, spacing(t, corner));
            const float cell = relative_size * std::max(least, here / 2);
            const float cells = std::ceil(height / cell) * std::ceil(longest / cell) / 2;
            if (cells > kCellsPerChunk || longest > 4 * here) {
                const Vec3f middle = (p[0] + p[1]) / 2;
                pending.push_back({p[0], middle, p[2]});
                pending.push_back({middle, p[1], p[2]});
                continue;
            }
            pieces.push_back({p, t, here, normal, 0});
        }
    }

    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const auto& piece : pieces) {
        low = low.cwiseMin(piece.corner[0]);
        high = high.cwiseMax(piece.corner[0]);
    }
    for (auto& piece : pieces)
        piece.morton = morton_code(piece.corner[0], low, (high - low).maxCoeff());
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.morton < b.morton; });
    chunks.reserve(pieces.size());
    for (const auto& piece : pieces)
        add_cells(piece, relative_size * piece.spacing);
    build_tree(pieces);
}

void CoverCells::add_cells(const Piece& piece, float cell_size) {
    const auto first = static_cast<std::uint32_t>(x.size());
    const Vec3f base = piece.corner[1] - piece.corner[0];
    const float length = base.norm();
    const Vec3f u = length > 0 ? Vec3f(base / length) : Vec3f::UnitX();
    const Vec3f apex = piece.corner[2] - piece.corner[0];
    const float apex_x = apex.dot(u);
    const Vec3f up = apex - apex_x * u;
    const float height = up.norm();
    const Vec3f v = height > 0 ? Vec3f(up / height) : Vec3f::Zero();

    const int rows = std::max(1, static_cast<int>(std::ceil(height / cell_size)));
    for (int row = 0; row < rows; ++row) {
        const float f0 = static_cast<float>(row) / static_cast<float>(rows);
        const float f1 = static_cast<float>(row + 1) / static_cast<float>(rows);
        const float left0 = f0 * apex_x, left1 = f1 * apex_x;
        const float width0 = (1 - f0) * length, width1 = (1 - f1) * length;
        const int columns = std::max(1, static_cast<int>(std::ceil((width0 + width1) / 2 / cell_size)));
        for (int column = 0; column < columns; ++column) {
            const float g0 = static_cast<float>(column) / static_cast<float>(columns);
            const float g1 = static_cast<float>(column + 1) / static_cast<float>(columns);
            const float x00 = left0 + g0 * width0, x10 = left0 + g1 * width0;
            const float x01 = left1 + g0 * width1, x11 = left1 + g1 * width1;
            // Centre of the mid-line; its distance to the four corners bounds the cell, which is convex.
            const float cx = (x00 + x10 + x01 + x11) / 4, half = (f1 - f0) * height / 2;
            const float reach = std::max({cx - x00, x10 - cx, std::abs(x01 - cx), std::abs(x11 - cx)});
            const Vec3f centre = piece.corner[0] + cx * u + (f0 + f1) / 2 * height * v;
            x.push_back(centre.x());
            y.push_back(centre.y());
            z.push_back(centre.z());
            margin.push_back(std::hypot(reach, half) + kRoundingSlack);
            area.push_back((x10 - x00 + x11 - x01) * half);
            chunk_of.push_back(static_cast<std::uint32_t>(chunks.size()));
        }
    }
    chunks.push_back(
        {first, static_cast<std::uint32_t>(x.size()) - first, piece.triangle, piece.spacing, piece.normal});
}

void CoverCells::build_tree(const std::vector<Piece>& pieces) {
    std::vector<Box> boxes;
    boxes.reserve(pieces.size());
    for (const auto& piece : pieces) {
        const auto& p = piece.corner;
        boxes.push_back({p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2])});
    }
    levels_.push_back(std::move(boxes));
    while (levels_.back().size() > 1) {
        const auto& below = levels_.back();
        std::vector<Box> above;
        above.reserve(below.size() / kBranching + 1);
        for (std::size_t i = 0; i < below.size(); ++i) {
            if (i % kBranching == 0) {
                above.push_back(below[i]);
            } else {
                above.back().low = above.back().low.cwiseMin(below[i].low);
                above.back().high = above.back().high.cwiseMax(below[i].high);
            }
        }
        levels_.push_back(std::move(above));
    }
}

}  // namespace splice
