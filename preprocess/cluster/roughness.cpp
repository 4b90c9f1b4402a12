#include "preprocess/cluster/roughness.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace splice {
namespace {

constexpr std::size_t kFine = 3;  // grid cells a radius
constexpr float kFineSide = kRoughnessRadius / kFine;
constexpr std::size_t kBlocksPerSide = 51;  // blocks of one radius across the unit box, one to spare
constexpr std::size_t kCellsPerBlock = kFine * kFine * kFine;
constexpr std::size_t kDirections = 24;    // the sides of a cube, four squares each
constexpr double kSampleBudget = 400'000;  // samples beyond one a face

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
    const std::size_t in_block = (cell[2] * kFine + cell[1]) * kFine + cell[0];
    return (block_index(block[0], block[1], block[2]) * kCellsPerBlock + in_block) * kDirections + direction_of(n);
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
    double u = std::fmod(0.5 + i * 0.7548776662466927, 1.0), v = std::fmod(0.5 + i * 0.5698402909980532, 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
}

}  // namespace

SurfaceGrid::SurfaceGrid(const IndexedMesh& mesh, const FaceGraph& faces) : sample_begin_(count_samples(faces)) {
    struct Sample {
        Vec3f position;
        std::uint32_t slot;
    };
    std::vector<Sample> samples(sample_begin_.back());
    std::vector<std::uint64_t> keys(samples.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        const auto corners = faces.corners(mesh, s);
        const std::uint32_t first = sample_begin_[s], count = sample_begin_[s + 1] - first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec3f position = sample_position(corners, i, count);
            samples[first + i] = {position, static_cast<std::uint32_t>(s)};
            keys[first + i] = (cell_key(position, faces.normal[s]) << 32) | (first + i);
        }
    });
    tbb::parallel_sort(keys.begin(), keys.end());

    cell_of_sample_.resize(samples.size());
    block_begin_.assign(kBlocksPerSide * kBlocksPerSide * kBlocksPerSide + 1, 0);
    std::uint64_t open = ~std::uint64_t{0};
    for (const std::uint64_t key : keys) {
        if (key >> 32 != open) {
            open = key >> 32;
            cells_.emplace_back();
            ++block_begin_[open / (kCellsPerBlock * kDirections) + 1];
        }
        const auto i = static_cast<std::uint32_t>(key);
        const std::uint32_t slot = samples[i].slot;
        const float share = 1 / static_cast<float>(sample_begin_[slot + 1] - sample_begin_[slot]);
        const float area = faces.area[slot] * share;
        Cell& cell = cells_.back();
        cell.position += area * samples[i].position;
        cell.normal_sum += area * faces.normal[slot];
        cell.area += area;
        cell.triangles += share;
        cell_of_sample_[i] = static_cast<std::uint32_t>(cells_.size() - 1);
    }
    for (std::size_t b = 1; b < block_begin_.size(); ++b)
        block_begin_[b] += block_begin_[b - 1];
    for (Cell& cell : cells_) {
        cell.position /= cell.area;
        cell.direction = cell.normal_sum.normalized();
    }
}

template <class Visit>
void SurfaceGrid::for_each_in_ball(const Vec3f& centre, const Visit& visit) const {
    const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
    const auto high = [](std::size_t i) { return std::min(i + 1, kBlocksPerSide - 1); };
    const std::size_t x = block_of(centre.x()), y = block_of(centre.y()), z = block_of(centre.z());
    for (std::size_t bz = low(z); bz <= high(z); ++bz) {
        for (std::size_t by = low(y); by <= high(y); ++by) {
            const std::uint32_t last = block_begin_[block_index(high(x), by, bz) + 1];
            for (std::uint32_t c = block_begin_[block_index(low(x), by, bz)]; c < last; ++c) {
                const Vec3f offset = cells_[c].position - centre;
                if (offset.squaredNorm() <= kRoughnessRadius * kRoughnessRadius) visit(cells_[c]);
            }
        }
    }
}

FaceRoughness SurfaceGrid::measure(const FaceGraph& faces) const {
    struct Around {
        float ball, triangles;
    };
    std::vector<Around> around(cells_.size());
    tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t c) {
        constexpr float kDisk = std::numbers::pi_v<float> * kRoughnessRadius * kRoughnessRadius;
        Vec3f normal_sum = Vec3f::Zero();
        float area = 0, triangles = 0;
        for_each_in_ball(cells_[c].position, [&](const Cell& cell) {
            normal_sum += cell.normal_sum;
            area += cell.area;
            triangles += cell.triangles;
        });
        around[c] = {normal_spread(normal_sum, area), triangles * kDisk / area};
    });

    FaceRoughness result;
    result.ball.resize(faces.size());
    result.triangles.resize(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        Around sum{0, 0};
        for (std::uint32_t i = sample_begin_[s]; i < sample_begin_[s + 1]; ++i) {
            sum.ball += around[cell_of_sample_[i]].ball;
            sum.triangles += around[cell_of_sample_[i]].triangles;
        }
        const auto count = static_cast<float>(sample_begin_[s + 1] - sample_begin_[s]);
        result.ball[s] = sum.ball / count;
        result.triangles[s] = sum.triangles / count;
    });
    return result;
}

float SurfaceGrid::sheet_spread(const Vec3f& centre, const Vec3f& normal, float cone) const {
    const float least = std::cos(cone);
    Vec3f normal_sum = Vec3f::Zero();
    float area = 0;
    for_each_in_ball(centre, [&](const Cell& cell) {
        if (cell.direction.dot(normal) < least) return;
        normal_sum += cell.normal_sum;
        area += cell.area;
    });
    return area > 0 ? normal_spread(normal_sum, area) : 0;
}

}  // namespace splice
