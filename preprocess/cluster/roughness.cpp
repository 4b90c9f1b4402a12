#include "preprocess/cluster/roughness.h"

#include "preprocess/cluster/neighbourhood.h"
#include "preprocess/cluster/radix_sort.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace splice {
namespace {

constexpr std::size_t kFine = 2;  // grid cells a radius
constexpr float kFineSide = kRoughnessRadius / kFine;
constexpr std::size_t kBlocksPerSide = 51;  // blocks of one radius across the unit box, one to spare
constexpr std::size_t kCellsPerBlock = kFine * kFine * kFine;
constexpr std::size_t kDirections = 24;    // the sides of a cube, four squares each
constexpr double kSampleBudget = 400'000;  // samples beyond one a face

std::size_t block_of(float x) {
    return static_cast<std::size_t>(std::clamp((x + 0.5f) / kRoughnessRadius, 0.0f, kBlocksPerSide - 1.0f));
}

/// The blocks that the mesh may touch: a box of them, numbered x fastest, so that three neighbours in x are one run.
struct BlockBox {
    std::array<std::size_t, 3> first{}, size{};

    explicit BlockBox(const IndexedMesh& mesh) {
        Vec3f low = Vec3f::Constant(0.5f), high = Vec3f::Constant(-0.5f);
        for (const Vec3f& p : mesh.positions) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        constexpr float kRounding = 1e-5f;  // of samples inside triangles
        for (int i = 0; i < 3; ++i) {
            const auto axis = static_cast<std::size_t>(i);
            first[axis] = block_of(low[i] - kRounding);
            size[axis] = block_of(high[i] + kRounding) + 1 - first[axis];
        }
    }
    std::size_t count() const { return size[0] * size[1] * size[2]; }
    /// Of the block with these coordinates in the box.
    std::size_t index(std::size_t x, std::size_t y, std::size_t z) const { return (z * size[1] + y) * size[0] + x; }
};

std::size_t direction_of(const Vec3f& n) {
    Eigen::Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const auto negative = [&](Eigen::Index i) { return n[i % 3] < 0 ? std::size_t{1} : std::size_t{0}; };
    const std::size_t side = 2 * static_cast<std::size_t>(axis) + negative(axis);
    return side * 4 + negative(axis + 1) * 2 + negative(axis + 2);
}

std::uint64_t cell_key(const BlockBox& box, const Vec3f& p, const Vec3f& n) {
    std::size_t block[3], cell[3];
    for (int i = 0; i < 3; ++i) {
        const std::size_t place = block_of(p[i]);
        const float inside = (p[i] + 0.5f) - static_cast<float>(place) * kRoughnessRadius;
        block[i] = place - box.first[static_cast<std::size_t>(i)];
        cell[i] = static_cast<std::size_t>(std::clamp(inside / kFineSide, 0.0f, kFine - 1.0f));
    }
    const std::size_t in_block = (cell[2] * kFine + cell[1]) * kFine + cell[0];
    return (box.index(block[0], block[1], block[2]) * kCellsPerBlock + in_block) * kDirections + direction_of(n);
}

/// First sample of each slot, and the number of all: one a face and one more for each cell-sized piece of its area.
std::vector<std::uint32_t> count_samples(const FaceGraph& faces) {
    double total = 0;
    for (const float a : faces.area)
        total += static_cast<double>(a);
    const double piece = std::max(double{kFineSide} * double{kFineSide}, total / kSampleBudget);
    std::vector<std::uint32_t> begin(faces.size() + 1, 0);
    for (std::size_t s = 0; s < faces.size(); ++s) {
        begin[s + 1] = begin[s] + 1 + static_cast<std::uint32_t>(static_cast<double>(faces.area[s]) / piece);
    }
    return begin;
}

/// The R2 sequence (Roberts 2018), folded into the triangle; the centroid for a single sample.
Vec3f sample_position(const std::array<Vec3f, 3>& corners, std::uint32_t i, std::uint32_t count) {
    const auto& [a, b, c] = corners;
    if (count == 1) return (a + b + c) / 3.0f;
    double u = fraction(0.5 + i * 0.7548776662466927), v = fraction(0.5 + i * 0.5698402909980532);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
}

struct SurfaceGrid {
    BlockBox box;
    std::vector<Cell> cells;                  // by block of one radius
    std::vector<std::uint32_t> block_begin;   // into cells
    std::vector<std::uint32_t> sample_begin;  // by slot: faces are cut into samples of about one cell
    std::vector<std::uint32_t> cell_of_sample;
};

SurfaceGrid build_grid(const IndexedMesh& mesh, const FaceGraph& faces) {
    SurfaceGrid grid{.box = BlockBox(mesh), .cells = {}, .block_begin = {}, .sample_begin = {}, .cell_of_sample = {}};
    grid.sample_begin = count_samples(faces);
    struct Sample {
        Vec3f position;
        std::uint32_t slot;
    };
    std::vector<Sample> samples(grid.sample_begin.back());
    std::vector<std::uint64_t> keys(samples.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        const auto corners = faces.corners(mesh, s);
        const std::uint32_t first = grid.sample_begin[s], count = grid.sample_begin[s + 1] - first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3f position = sample_position(corners, i, count);
            samples[first + i] = {position, static_cast<std::uint32_t>(s)};
            keys[first + i] = (cell_key(grid.box, position, faces.normal[s]) << 32) | (first + i);
        }
    });
    radix_sort_by_high_half(keys);

    grid.cell_of_sample.resize(samples.size());
    grid.block_begin.assign(grid.box.count() + 1, 0);
    // Counted first: growing would touch fresh memory several times.
    std::uint64_t open = ~std::uint64_t{0};
    std::size_t cells = 0;
    for (const std::uint64_t key : keys)
        cells += std::exchange(open, key >> 32) != key >> 32 ? 1u : 0u;
    grid.cells.reserve(cells);
    open = ~std::uint64_t{0};
    for (const std::uint64_t key : keys) {
        if (key >> 32 != open) {
            open = key >> 32;
            grid.cells.emplace_back();
            ++grid.block_begin[open / (kCellsPerBlock * kDirections) + 1];
        }
        const auto i = static_cast<std::uint32_t>(key);
        const std::uint32_t slot = samples[i].slot;
        const float share = 1 / static_cast<float>(grid.sample_begin[slot + 1] - grid.sample_begin[slot]);
        const float area = faces.area[slot] * share;
        Cell& cell = grid.cells.back();
        cell.position += area * samples[i].position;
        cell.normal_sum += area * faces.normal[slot];
        cell.area += area;
        cell.triangles += share;
        grid.cell_of_sample[i] = static_cast<std::uint32_t>(grid.cells.size() - 1);
    }
    for (std::size_t b = 1; b < grid.block_begin.size(); ++b)
        grid.block_begin[b] += grid.block_begin[b - 1];
    for (Cell& cell : grid.cells) {
        cell.position /= cell.area;
        cell.direction = cell.normal_sum.normalized();
    }
    return grid;
}

/// The cells in and around a block, as runs in x. They hold the ball around any place in the block.
CellRuns runs_around(const SurfaceGrid& grid, std::size_t block) {
    const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const auto& size = grid.box.size;
    const std::size_t x = block % size[0], y = block / size[0] % size[1], z = block / size[0] / size[1];
    const auto high = [&](std::size_t i, std::size_t axis) { return std::min(i + 1, size[axis] - 1); };
    CellRuns runs;
    std::size_t run = 0;
    for (std::size_t bz = low(z); bz <= high(z, 2); ++bz) {
        for (std::size_t by = low(y); by <= high(y, 1); ++by) {
            const std::uint32_t first = grid.block_begin[grid.box.index(low(x), by, bz)];
            const std::uint32_t last = grid.block_begin[grid.box.index(high(x, 0), by, bz) + 1];
            runs[run++] = {grid.cells.data() + first, last - first};
        }
    }
    return runs;
}

std::vector<Neighbourhood> look_around_cells(const SurfaceGrid& grid) {
    std::vector<Neighbourhood> around(grid.cells.size());
    tbb::parallel_for(std::size_t{0}, grid.block_begin.size() - 1, [&](std::size_t block) {
        const std::uint32_t last = grid.block_begin[block + 1];
        if (grid.block_begin[block] == last) return;
        const auto runs = runs_around(grid, block);
        const std::uint32_t first = grid.block_begin[block];
        look_around(runs, {grid.cells.data() + first, last - first}, around.data() + first);
    });
    return around;
}

}  // namespace

FaceRoughness measure_roughness(const IndexedMesh& mesh, const FaceGraph& faces) {
    const SurfaceGrid grid = build_grid(mesh, faces);
    const std::vector<Neighbourhood> around = look_around_cells(grid);
    FaceRoughness result;
    for (auto* values : {&result.ball, &result.sheet, &result.triangles})
        values->resize(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        Neighbourhood sum{0, 0, 0};
        for (std::uint32_t i = grid.sample_begin[s]; i < grid.sample_begin[s + 1]; ++i) {
            const Neighbourhood& n = around[grid.cell_of_sample[i]];
            sum = {sum.ball + n.ball, sum.sheet + n.sheet, sum.triangles + n.triangles};
        }
        const auto count = static_cast<float>(grid.sample_begin[s + 1] - grid.sample_begin[s]);
        result.ball[s] = sum.ball / count;
        result.sheet[s] = sum.sheet / count;
        result.triangles[s] = sum.triangles / count;
    });
    return result;
}

}  // namespace splice
