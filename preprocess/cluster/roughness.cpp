#include "preprocess/cluster/roughness.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace splice {
namespace {

constexpr std::size_t kFine = 3;  // grid cells a radius
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
    const std::size_t side = static_cast<std::size_t>(axis) * 2 + (n[axis] < 0);
    return side * 4 + (n[(axis + 1) % 3] < 0) * 2 + (n[(axis + 2) % 3] < 0);
}

std::uint64_t cell_key(const Vec3f& p, const Vec3f& n) {
    std::size_t block[3], cell[3];
    for (int i = 0; i < 3; ++i) {
        block[i] = block_of(p[i]);
        const float inside = (p[i] + 0.5f) - static_cast<float>(block[i]) * kRoughnessRadius;
        cell[i] = static_cast<std::size_t>(std::clamp(inside / kFineSide, 0.0f, kFine - 1.0f));
    }
    return (block_index(block[0], block[1], block[2]) * kCellsPerBlock + (cell[2] * kFine + cell[1]) * kFine +
            cell[0]) *
               kDirections +
           direction_of(n);
}

/// Faces cut into samples of about one grid cell: sample i of face s stands for area[s] / count.
class Samples {
  public:
    Samples(const IndexedMesh& mesh, const FaceGraph& faces) : mesh_(mesh), faces_(faces), begin_(faces.size() + 1, 0) {
        double total = 0;
        for (const float a : faces.area)
            total += static_cast<double>(a);
        const double share = std::max(double{kFineSide} * double{kFineSide}, total / kSampleBudget);
        for (std::size_t s = 0; s < faces.size(); ++s) {
            begin_[s + 1] = begin_[s] + 1 + static_cast<std::uint32_t>(static_cast<double>(faces.area[s]) / share);
        }
    }
    std::size_t size() const { return begin_.back(); }
    std::uint32_t begin(std::size_t slot) const { return begin_[slot]; }
    std::uint32_t count(std::size_t slot) const { return begin_[slot + 1] - begin_[slot]; }
    /// The R2 sequence (Roberts 2018), folded into the triangle; the centroid for a single sample.
    Vec3f position(std::size_t slot, std::uint32_t i) const {
        const auto [a, b, c] = faces_.corners(mesh_, slot);
        if (count(slot) == 1) return (a + b + c) / 3.0f;
        double u = std::fmod(0.5 + i * 0.7548776662466927, 1.0), v = std::fmod(0.5 + i * 0.5698402909980532, 1.0);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
    }

  private:
    const IndexedMesh& mesh_;
    const FaceGraph& faces_;
    std::vector<std::uint32_t> begin_;
};

/// The surface inside one grid cell that faces one way.
struct Cell {
    Vec3f position = Vec3f::Zero();    // area-weighted mean
    Vec3f normal_sum = Vec3f::Zero();  // area weighted
    Vec3f direction = Vec3f::Zero();   // unit
    float area = 0;
};

struct CellGrid {
    std::vector<Cell> cells;                 // by block
    std::vector<std::uint32_t> block_begin;  // into cells
    std::vector<std::uint32_t> cell_of_sample;
};

CellGrid sum_cells(const FaceGraph& faces, const Samples& samples) {
    std::vector<std::uint64_t> keys(samples.size());
    std::vector<std::uint32_t> slot_of(samples.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        for (std::uint32_t i = 0; i < samples.count(s); ++i) {
            const std::uint32_t sample = samples.begin(s) + i;
            keys[sample] = (cell_key(samples.position(s, i), faces.normal[s]) << 32) | sample;
            slot_of[sample] = static_cast<std::uint32_t>(s);
        }
    });
    tbb::parallel_sort(keys.begin(), keys.end());

    CellGrid grid;
    grid.cell_of_sample.resize(samples.size());
    grid.block_begin.assign(kBlocksPerSide * kBlocksPerSide * kBlocksPerSide + 1, 0);
    std::uint64_t open = ~std::uint64_t{0};
    for (const std::uint64_t key : keys) {
        if (key >> 32 != open) {
            open = key >> 32;
            grid.cells.emplace_back();
            ++grid.block_begin[open / (kCellsPerBlock * kDirections) + 1];
        }
        const auto sample = static_cast<std::uint32_t>(key);
        const std::uint32_t slot = slot_of[sample];
        const float area = faces.area[slot] / static_cast<float>(samples.count(slot));
        Cell& cell = grid.cells.back();
        cell.position += area * samples.position(slot, sample - samples.begin(slot));
        cell.normal_sum += area * faces.normal[slot];
        cell.area += area;
        grid.cell_of_sample[sample] = static_cast<std::uint32_t>(grid.cells.size() - 1);
    }
    for (std::size_t b = 1; b < grid.block_begin.size(); ++b)
        grid.block_begin[b] += grid.block_begin[b - 1];
    for (Cell& cell : grid.cells) {
        cell.position /= cell.area;
        cell.direction = cell.normal_sum.normalized();
    }
    return grid;
}

float spread(const Vec3f& normal_sum, float area) {
    return area > 0 ? std::sqrt(std::max(0.0f, 2 * (1 - normal_sum.norm() / area))) : 0.0f;
}

struct Spreads {
    float ball, sheet;
};

Spreads spreads_at(const CellGrid& grid, const Cell& centre) {
    Vec3f ball_sum = Vec3f::Zero(), sheet_sum = Vec3f::Zero();
    float ball_area = 0, sheet_area = 0;
    const std::size_t x = block_of(centre.position.x()), y = block_of(centre.position.y()),
                      z = block_of(centre.position.z());
    const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const auto high = [](std::size_t i) { return std::min(i + 1, kBlocksPerSide - 1); };
    for (std::size_t bz = low(z); bz <= high(z); ++bz) {
        for (std::size_t by = low(y); by <= high(y); ++by) {
            const std::uint32_t last = grid.block_begin[block_index(high(x), by, bz) + 1];
            for (std::uint32_t c = grid.block_begin[block_index(low(x), by, bz)]; c < last; ++c) {
                const Cell& cell = grid.cells[c];
                if ((cell.position - centre.position).squaredNorm() > kRoughnessRadius * kRoughnessRadius) continue;
                ball_sum += cell.normal_sum;
                ball_area += cell.area;
                if (cell.direction.dot(centre.direction) < kSheetCosine) continue;
                sheet_sum += cell.normal_sum;
                sheet_area += cell.area;
            }
        }
    }
    return {spread(ball_sum, ball_area), spread(sheet_sum, sheet_area)};
}

}  // namespace

FaceRoughness measure_roughness(const IndexedMesh& mesh, const FaceGraph& faces) {
    const Samples samples(mesh, faces);
    const CellGrid grid = sum_cells(faces, samples);
    std::vector<Spreads> of_cell(grid.cells.size());
    tbb::parallel_for(std::size_t{0}, grid.cells.size(),
                      [&](std::size_t c) { of_cell[c] = spreads_at(grid, grid.cells[c]); });

    FaceRoughness result;
    result.ball.resize(faces.size());
    result.sheet.resize(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        Spreads sum{0, 0};
        for (std::uint32_t i = samples.begin(s); i < samples.begin(s) + samples.count(s); ++i) {
            sum.ball += of_cell[grid.cell_of_sample[i]].ball;
            sum.sheet += of_cell[grid.cell_of_sample[i]].sheet;
        }
        result.ball[s] = sum.ball / static_cast<float>(samples.count(s));
        result.sheet[s] = sum.sheet / static_cast<float>(samples.count(s));
    });
    return result;
}

}  // namespace splice
