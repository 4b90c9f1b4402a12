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
constexpr std::uint32_t kDirections = 24;  // the sides of a cube, four squares each
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

/// Which side of the cube a normal pierces and in which quarter of it. Without branches: no predictor can know.
std::uint32_t direction_of(const Vec3f& n) {
    const float x = std::abs(n.x()), y = std::abs(n.y()), z = std::abs(n.z());
    const std::uint32_t axis = z > std::max(x, y) ? 2u : y > x ? 1u : 0u;
    const std::uint32_t negative = (n.x() < 0 ? 1u : 0u) | (n.y() < 0 ? 2u : 0u) | (n.z() < 0 ? 4u : 0u);
    const std::uint32_t from_axis = (negative | negative << 3) >> axis;  // bits of the axis, the next, the one after
    return axis * 8 + (from_axis & 1u) * 4 + (from_axis & 2u) + (from_axis >> 2 & 1u);
}

/// Numbers cells by block, place in it and direction. All axes at a time in one vector, without branches.
class CellKeys {
  public:
    explicit CellKeys(const BlockBox& box)
        : first_{static_cast<float>(box.first[0]), static_cast<float>(box.first[1]), static_cast<float>(box.first[2])},
          stride_{kCellsPerBlock, static_cast<float>(kCellsPerBlock * box.size[0]),
                  static_cast<float>(kCellsPerBlock * box.size[0] * box.size[1])} {}
    std::uint32_t operator()(const Vec3f& p, std::uint32_t direction) const {
        const Axes moved = Axes{p.x(), p.y(), p.z()} + 0.5f;
        const Axes block = whole(moved / kRoughnessRadius, kBlocksPerSide - 1.0f);
        const Axes cell = whole((moved - block * kRoughnessRadius) / kFineSide, kFine - 1.0f);
        // Whole numbers below 2^24, exact.
        const Axes parts = (block - first_) * stride_ + cell * Axes{1, kFine, kFine * kFine};
        return static_cast<std::uint32_t>(static_cast<int>(parts[0] + parts[1] + parts[2])) * kDirections + direction;
    }

  private:
    using Axes = float __attribute__((vector_size(16)));
    using Counts = std::int32_t __attribute__((vector_size(16)));
    /// Whole part, from 0 to `highest`.
    static Axes whole(Axes x, float highest) {
        x = x < 0 ? Axes{} : x;
        x = x > highest ? Axes{} + highest : x;
        return __builtin_convertvector(__builtin_convertvector(x, Counts), Axes);
    }
    Axes first_, stride_;
};

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

/// Places in a triangle, as shares of its two sides from the first corner: the R2 sequence (Roberts 2018), folded.
struct Places {
    std::vector<float> u, v;

    explicit Places(std::uint32_t count) : u(count), v(count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const double x = fraction(0.5 + i * 0.7548776662466927), y = fraction(0.5 + i * 0.5698402909980532);
            u[i] = static_cast<float>(x + y > 1 ? 1 - x : x);
            v[i] = static_cast<float>(x + y > 1 ? 1 - y : y);
        }
    }
};

struct SurfaceGrid {
    BlockBox box;
    std::vector<Cell> cells;                  // by block of one radius
    std::vector<std::uint32_t> block_begin;   // into cells
    std::vector<std::uint32_t> sample_begin;  // by slot: faces are cut into samples of about one cell
    std::vector<std::uint32_t> cell_of_sample;
};

/// A piece of a face, in the cell that its high half numbers.
struct Sample {
    Vec3f position;
    std::uint32_t slot;
};

struct Samples {
    std::vector<Sample> samples;
    std::vector<std::uint64_t> keys;  // cell's number, sample's number; in this order
};

Samples sample_faces(const IndexedMesh& mesh, const FaceGraph& faces, const SurfaceGrid& grid) {
    const std::vector<std::uint32_t>& begin = grid.sample_begin;
    std::uint32_t most = 0;
    for (std::size_t s = 0; s < faces.size(); ++s)
        most = std::max(most, begin[s + 1] - begin[s]);
    const Places places(most);
    const CellKeys key(grid.box);
    Samples result{std::vector<Sample>(begin.back()), std::vector<std::uint64_t>(begin.back())};
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        const auto [a, b, c] = faces.corners(mesh, s);
        const std::uint32_t direction = direction_of(faces.normal[s]), first = begin[s], count = begin[s + 1] - first;
        for (std::uint32_t i = 0; i < count; ++i) {
            // The centroid for a single one.
            const Vec3f position =
                count == 1 ? Vec3f((a + b + c) / 3.0f) : Vec3f(a + places.u[i] * (b - a) + places.v[i] * (c - a));
            result.samples[first + i] = {position, static_cast<std::uint32_t>(s)};
            result.keys[first + i] = (std::uint64_t{key(position, direction)} << 32) | (first + i);
        }
    });
    radix_sort_by_high_half(result.keys);
    return result;
}

SurfaceGrid build_grid(const IndexedMesh& mesh, const FaceGraph& faces) {
    SurfaceGrid grid{.box = BlockBox(mesh), .cells = {}, .block_begin = {}, .sample_begin = {}, .cell_of_sample = {}};
    grid.sample_begin = count_samples(faces);
    const auto [samples, keys] = sample_faces(mesh, faces, grid);

    grid.cell_of_sample.resize(samples.size());
    grid.block_begin.assign(grid.box.count() + 1, 0);
    // Counted first: growing would touch fresh memory several times.
    std::uint64_t last = ~std::uint64_t{0};
    std::size_t cells = 0;
    for (const std::uint64_t key : keys)
        cells += std::exchange(last, key >> 32) != key >> 32 ? 1u : 0u;
    grid.cells.reserve(cells);
    for (std::size_t k = 0; k < keys.size();) {
        const std::uint64_t open = keys[k] >> 32;
        Cell cell;
        for (; k < keys.size() && keys[k] >> 32 == open; ++k) {
            const auto i = static_cast<std::uint32_t>(keys[k]);
            const auto& [position, slot] = samples[i];
            const float share = 1 / static_cast<float>(grid.sample_begin[slot + 1] - grid.sample_begin[slot]);
            const float area = faces.area[slot] * share;
            cell.position += area * position;
            cell.normal_sum += area * faces.normal[slot];
            cell.area += area;
            cell.triangles += share;
            grid.cell_of_sample[i] = static_cast<std::uint32_t>(grid.cells.size());
        }
        cell.position /= cell.area;
        cell.direction = cell.normal_sum.normalized();
        grid.cells.push_back(cell);
        ++grid.block_begin[open / (kCellsPerBlock * kDirections) + 1];
    }
    for (std::size_t b = 1; b < grid.block_begin.size(); ++b)
        grid.block_begin[b] += grid.block_begin[b - 1];
    return grid;
}

/// The cells in and around blocks x to x + wide - 1 of a row, as runs in x. They hold the ball around any place in
/// these blocks.
CellRuns runs_around(const SurfaceGrid& grid, std::size_t row, std::size_t x, std::size_t wide) {
    const auto& size = grid.box.size;
    const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const auto high = [&](std::size_t i, std::size_t axis) { return std::min(i + 1, size[axis] - 1); };
    const std::size_t y = row % size[1], z = row / size[1];
    CellRuns runs;
    std::size_t run = 0;
    for (std::size_t bz = low(z); bz <= high(z, 2); ++bz) {
        for (std::size_t by = low(y); by <= high(y, 1); ++by) {
            const std::uint32_t first = grid.block_begin[grid.box.index(low(x), by, bz)];
            const std::uint32_t last = grid.block_begin[grid.box.index(high(x + wide - 1, 0), by, bz) + 1];
            runs[run++] = {grid.cells.data() + first, last - first};
        }
    }
    return runs;
}

/// The cells of a row of blocks in x, as many at a time as one vector holds, though they lie in several blocks: blocks
/// of a coarse mesh have three or four.
void look_around_row(const SurfaceGrid& grid, std::size_t row, std::vector<Neighbourhood>& around) {
    const std::uint32_t* const begin = grid.block_begin.data() + row * grid.box.size[0];
    const std::uint32_t last = begin[grid.box.size[0]];
    std::size_t x = 0;
    for (std::uint32_t cell = begin[0]; cell < last;) {
        while (begin[x + 1] <= cell)
            ++x;
        const std::uint32_t end = std::min(last, cell + kCentresAtOnce);
        std::size_t wide = 1;
        while (begin[x + wide] < end)
            ++wide;
        look_around(runs_around(grid, row, x, wide), {grid.cells.data() + cell, end - cell}, around.data() + cell);
        cell = end;
    }
}

std::vector<Neighbourhood> look_around_cells(const SurfaceGrid& grid) {
    std::vector<Neighbourhood> around(grid.cells.size());
    tbb::parallel_for(std::size_t{0}, grid.box.size[1] * grid.box.size[2],
                      [&](std::size_t row) { look_around_row(grid, row, around); });
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
