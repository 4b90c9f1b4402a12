// Triangles are bisected across their longest edge until a piece needs few cells of one size; a piece is then cut into
// rows parallel to its longest edge and each row into trapezoids, so slivers get one row and nothing depends on the
// neighbours. No cell is much longer than wide: a disk covers cells whole, and would grow with them.
#include "preprocess/surfel/cover_cells.h"

#include "preprocess/surfel/morton.h"
#include "preprocess/surfel/surface_point.h"

#include <limits>

namespace splice {
namespace {

constexpr float kCellsPerChunk = 48;
constexpr std::uint32_t kCellsPerGroup = 24;
constexpr float kSpacingsPerChunk = 4;    // longest edge of a chunk
constexpr float kLeastUniformity = 0.8f;  // smallest spacing in a chunk over the one that all its cells get
// Rounding of centres and radii stays below this: positions are within the unit box, so a float's last bit is 6e-8.
constexpr float kRoundingSlack = 5e-7f;

using Corners = std::array<Vec3f, 3>;

void put_longest_edge_first(Corners& p) {
    const float a = (p[1] - p[0]).squaredNorm(), b = (p[2] - p[1]).squaredNorm(), c = (p[0] - p[2]).squaredNorm();
    if (b > a && b >= c) {
        std::rotate(p.begin(), p.begin() + 1, p.end());
    } else if (c > a && c > b) {
        std::rotate(p.begin(), p.begin() + 2, p.end());
    }
}

}  // namespace

CoverCells::CoverCells(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, const Spacing& spacing,
                       float relative_size) {
    chunks.reserve(triangles.size());
    for (const auto t : triangles)
        cut_triangle(mesh, t, spacing, relative_size);
    sort_chunks();
    add_cells();
    group_chunks();
    build_tree();
}

void CoverCells::cut_triangle(const IndexedMesh& mesh, std::uint32_t triangle, const Spacing& spacing,
                              float relative_size) {
    const auto& v = mesh.triangles[triangle];
    const Vec3f normal = face_normal(mesh, triangle);
    std::vector<Corners> pending = {{mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]}};
    while (!pending.empty()) {
        Corners p = pending.back();
        pending.pop_back();
        put_longest_edge_first(p);
        const float here = spacing(triangle, (p[0] + p[1] + p[2]) / 3);
        float least = here;
        for (const auto& corner : p)
            least = std::min(least, spacing(triangle, corner));
        const float longest = (p[1] - p[0]).norm();
        const float height =
            (p[1] - p[0]).cross(p[2] - p[0]).norm() / std::max(longest, std::numeric_limits<float>::min());
        const float cell = relative_size * here;
        const float cells = std::ceil(height / cell) * std::ceil(longest / cell) / 2;
        const bool uneven = least < kLeastUniformity * here && longest > 2 * relative_size * least;
        if (cells > kCellsPerChunk || longest > kSpacingsPerChunk * here || uneven) {
            const Vec3f middle = (p[0] + p[1]) / 2;
            pending.push_back({p[0], middle, p[2]});
            pending.push_back({middle, p[1], p[2]});
            continue;
        }
        chunks.push_back({0, 0, triangle, here, normal, p, cell});
    }
}

void CoverCells::sort_chunks() {
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const auto& chunk : chunks) {
        low = low.cwiseMin(chunk.corner[0]);
        high = high.cwiseMax(chunk.corner[0]);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order(chunks.size());
    for (std::uint32_t i = 0; i < chunks.size(); ++i) {
        order[i] = {morton_code(chunks[i].corner[0], low, (high - low).maxCoeff()), i};
    }
    std::sort(order.begin(), order.end());
    std::vector<CellChunk> sorted;
    sorted.reserve(chunks.size());
    for (const auto& [code, i] : order)
        sorted.push_back(chunks[i]);
    chunks = std::move(sorted);
}

void CoverCells::add_cells() {
    for (std::uint32_t c = 0; c < chunks.size(); ++c) {
        chunks[c].first = static_cast<std::uint32_t>(x.size());
        for_each_cell(chunks[c], [&](std::uint32_t, const std::array<Vec3f, 4>& corner) {
            const Vec3f middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
            float reach2 = 0;
            for (const auto& p : corner)
                reach2 = std::max(reach2, (p - middle).squaredNorm());
            x.push_back(middle.x());
            y.push_back(middle.y());
            z.push_back(middle.z());
            margin.push_back(std::sqrt(reach2) + kRoundingSlack);
            area.push_back((corner[3] - corner[0]).cross(corner[2] - corner[1]).norm() / 2);
            chunk_of.push_back(c);
        });
        chunks[c].count = static_cast<std::uint32_t>(x.size()) - chunks[c].first;
    }
}

void CoverCells::group_chunks() {
    for (std::uint32_t first = 0; first < chunks.size();) {
        std::uint32_t end = first;
        Vec3f sum = Vec3f::Zero();
        while (end < chunks.size() && chunks[end].first - chunks[first].first < kCellsPerGroup)
            sum += chunks[end++].normal;
        const Vec3f axis = sum.squaredNorm() > 0 ? Vec3f(sum.normalized()) : chunks[first].normal;
        float cosine = 1;
        for (auto c = first; c < end; ++c)
            cosine = std::min(cosine, axis.dot(chunks[c].normal));
        groups_.push_back({first, end, chunks[first].first, chunks[end - 1].first + chunks[end - 1].count, axis, cosine,
                           std::sqrt(std::max(0.0f, 1 - cosine * cosine))});
        first = end;
    }
}

void CoverCells::build_tree() {
    std::vector<std::array<Vec3f, 2>> boxes;  // least and greatest corner
    boxes.reserve(groups_.size());
    for (const auto& group : groups_) {
        Vec3f low = chunks[group.first_chunk].corner[0], high = low;
        for (auto c = group.first_chunk; c < group.end_chunk; ++c) {
            for (const auto& p : chunks[c].corner) {
                low = low.cwiseMin(p);
                high = high.cwiseMax(p);
            }
        }
        boxes.push_back({low, high});
    }
    while (!boxes.empty()) {
        std::vector<Node> nodes((boxes.size() + kBranching - 1) / kBranching);
        std::vector<std::array<Vec3f, 2>> above;
        for (std::size_t i = 0; i < nodes.size() * kBranching; ++i) {
            const std::size_t k = i % kBranching;
            const bool present = i < boxes.size();
            for (int axis = 0; axis < 3; ++axis) {
                nodes[i / kBranching].low[axis][k] = present ? boxes[i][0][axis] : std::numeric_limits<float>::max();
                nodes[i / kBranching].high[axis][k] = present ? boxes[i][1][axis] : -std::numeric_limits<float>::max();
            }
            if (!present) continue;
            if (k == 0) {
                above.push_back(boxes[i]);
            } else {
                above.back()[0] = above.back()[0].cwiseMin(boxes[i][0]);
                above.back()[1] = above.back()[1].cwiseMax(boxes[i][1]);
            }
        }
        levels_.push_back(std::move(nodes));
        if (above.size() == 1) break;
        boxes = std::move(above);
    }
}

}  // namespace splice
