#include "preprocess/cluster/roughness.h"

#include "preprocess/cluster/radix_sort.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

namespace splice {
namespace {

constexpr std::size_t kFine = 2;  // grid cells a radius
constexpr float kFineSide = kRoughnessRadius / kFine;
constexpr std::size_t kBlocksPerSide = 51;  // blocks of one radius across the unit box, one to spare
constexpr std::size_t kCellsPerBlock = kFine * kFine * kFine;
constexpr std::size_t kDirections = 24;     // the sides of a cube, four squares each
constexpr float kSheetCosine = 0.8660254f;  // 30 degrees
constexpr double kSampleBudget = 400'000;   // samples beyond one a face

std::size_t block_of(float x) {
    return static_cast<std::size_t>(std::clamp((x + 0.5f) / kRoughnessRadius, 0.0f, kBlocksPerSide - 1.0f));
}

/// Blocks are numbered x fastest, so that three neighbours in x are one run.
std::size_t block_index(std::size_t x, std::size_t y, std::size_t z) {
    return (z * kBlocksPerSide + y) * kBlocksPerSide + x;
}

std::size_t direction_of(const Vec3f& n) {
    Eigen::Index axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const auto negative = [&](Eigen::Index i) { return n[i % 3] < 0 ? std::size_t{1} : std::size_t{0}; };
    const std::size_t side = 2 * static_cast<std::size_t>(axis) + negative(axis);
    return side * 4 + negative(axis + 1) * 2 + negative(axis + 2);
}

std::uint64_t cell_key(const Vec3f& p, const Vec3f& n) {
    std::size_t block[3], cell[3];
    for (int i = 0; i < 3; ++i) {
        block[i] = block_of(p[i]);
        const float inside = (p[i] + 0.5f) - static_cast<float>(block[i]) * kRoughnessRadius;
        cell[i] = static_cast<std::size_t>(std::clamp(inside / kFineSide, 0.0f, kFine - 1.0f));
    }
    const std::size_t in_block = (cell[2] * kFine + cell[1]) * kFine + cell[0];
    return (block_index(block[0], block[1], block[2]) * kCellsPerBlock + in_block) * kDirections + direction_of(n);
}

/// The spread of a set of normals in radians, 0 to sqrt 2: for small spreads their RMS angle to the mean.
float normal_spread(const Vec3f& area_weighted_sum, float area) {
    return std::sqrt(std::max(0.0f, 2 * (1 - area_weighted_sum.norm() / area)));
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

/// The surface inside one grid cell that faces one way.
struct Cell {
    Vec3f position = Vec3f::Zero();    // area-weighted mean
    Vec3f normal_sum = Vec3f::Zero();  // area weighted
    Vec3f direction = Vec3f::Zero();   // unit
    float area = 0;
    float triangles = 0;  // fractions of them
};

struct SurfaceGrid {
    std::vector<Cell> cells;                  // by block of one radius
    std::vector<std::uint32_t> block_begin;   // into cells
    std::vector<std::uint32_t> sample_begin;  // by slot: faces are cut into samples of about one cell
    std::vector<std::uint32_t> cell_of_sample;
};

SurfaceGrid build_grid(const IndexedMesh& mesh, const FaceGraph& faces) {
    SurfaceGrid grid;
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
            keys[first + i] = (cell_key(position, faces.normal[s]) << 32) | (first + i);
        }
    });
    radix_sort_by_high_half(keys);

    grid.cell_of_sample.resize(samples.size());
    grid.block_begin.assign(kBlocksPerSide * kBlocksPerSide * kBlocksPerSide + 1, 0);
    std::uint64_t open = ~std::uint64_t{0};
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

struct Neighbourhood {
    float ball, sheet, triangles;
};

/// The cells in and around a block, as runs in x. They hold the ball around any place in the block.
std::array<std::span<const Cell>, 9> runs_around(const SurfaceGrid& grid, std::size_t block) {
    const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const auto high = [](std::size_t i) { return std::min(i + 1, kBlocksPerSide - 1); };
    const std::size_t x = block % kBlocksPerSide, y = block / kBlocksPerSide % kBlocksPerSide,
                      z = block / kBlocksPerSide / kBlocksPerSide;
    std::array<std::span<const Cell>, 9> runs;
    std::size_t run = 0;
    for (std::size_t bz = low(z); bz <= high(z); ++bz) {
        for (std::size_t by = low(y); by <= high(y); ++by) {
            const std::uint32_t first = grid.block_begin[block_index(low(x), by, bz)];
            const std::uint32_t last = grid.block_begin[block_index(high(x), by, bz) + 1];
            runs[run++] = {grid.cells.data() + first, last - first};
        }
    }
    return runs;
}

// Four centres at a time, a lane each, because all centres of a block look at the same cells.
constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using Mask = std::int32_t __attribute__((vector_size(16)));

Lanes where(Mask mask, float value) {
    const Lanes spread = Lanes{} + value;
    return std::bit_cast<Lanes>(mask & std::bit_cast<Mask>(spread));
}

struct LaneVector {
    Lanes x{}, y{}, z{};

    void set(std::size_t lane, const Vec3f& v) { x[lane] = v.x(), y[lane] = v.y(), z[lane] = v.z(); }
    void add_where(Mask mask, const Vec3f& v) {
        x += where(mask, v.x());
        y += where(mask, v.y());
        z += where(mask, v.z());
    }
    Vec3f operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
};

/// What lies around up to four cells of one block.
void look_around(const std::array<std::span<const Cell>, 9>& runs, std::span<const Cell> centres, Neighbourhood* out) {
    constexpr float kDisk = std::numbers::pi_v<float> * kRoughnessRadius * kRoughnessRadius;
    LaneVector position, direction, ball_sum, sheet_sum;
    Lanes ball_area{}, sheet_area{}, triangles{};
    for (std::size_t i = 0; i < kLanes; ++i) {
        const Cell& centre = centres[std::min(i, centres.size() - 1)];
        position.set(i, centre.position);
        direction.set(i, centre.direction);
    }
    for (const std::span<const Cell> run : runs) {
        for (const Cell& cell : run) {
            const Lanes dx = cell.position.x() - position.x, dy = cell.position.y() - position.y,
                        dz = cell.position.z() - position.z;
            const Mask near = dx * dx + (dy * dy + dz * dz) <= kRoughnessRadius * kRoughnessRadius;
            const Lanes cosine = cell.direction.x() * direction.x +
                                 (cell.direction.y() * direction.y + cell.direction.z() * direction.z);
            const Mask same_sheet = near & ~(cosine < kSheetCosine);
            ball_sum.add_where(near, cell.normal_sum);
            ball_area += where(near, cell.area);
            triangles += where(near, cell.triangles);
            sheet_sum.add_where(same_sheet, cell.normal_sum);
            sheet_area += where(same_sheet, cell.area);
        }
    }
    for (std::size_t i = 0; i < centres.size(); ++i) {
        const float ball = normal_spread(ball_sum[i], ball_area[i]);
        // A cell whose normals cancel has no direction and no sheet.
        const float sheet = sheet_area[i] > 0 ? normal_spread(sheet_sum[i], sheet_area[i]) : ball;
        out[i] = {ball, sheet, triangles[i] * kDisk / ball_area[i]};
    }
}

std::vector<Neighbourhood> look_around_cells(const SurfaceGrid& grid) {
    std::vector<Neighbourhood> around(grid.cells.size());
    tbb::parallel_for(std::size_t{0}, grid.block_begin.size() - 1, [&](std::size_t block) {
        const std::uint32_t last = grid.block_begin[block + 1];
        if (grid.block_begin[block] == last) return;
        const auto runs = runs_around(grid, block);
        for (std::size_t first = grid.block_begin[block]; first < last; first += kLanes) {
            const std::size_t count = std::min(kLanes, last - first);
            look_around(runs, {grid.cells.data() + first, count}, around.data() + first);
        }
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
