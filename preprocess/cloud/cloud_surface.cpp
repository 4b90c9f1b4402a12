#include "preprocess/cloud/cloud_surface.h"

#include "preprocess/cloud/least_spread.h"
#include "preprocess/cloud/neighbour_search.h"
#include "preprocess/cloud/vicinity.h"
#include "preprocess/cloud/voronoi_cell.h"
#include "preprocess/large_vector.h"
#include "preprocess/model_format/tangent_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <span>

namespace splice {
namespace {

// Points along a scan line, whose nearest neighbours all lie on that line, define no plane: the second standard
// deviation is below this share of the first. They are asked again with more neighbours.
constexpr double kLineShare = 0.25;
constexpr unsigned kMoreNeighbours = 4;  // times as many

// Where noise is as wide as the spacing, the nearest neighbours lie all around and not in a plane: the least standard
// deviation is above this share of the second, and at more than so many of the points.
constexpr double kSpatial = 0.5, kSpatialPoints = 0.75;
constexpr std::size_t kSampledBlocks = 256;

// Neighbours that rise more steeply from the plane than this (60 degrees) belong to another sheet, or are noise.
constexpr float kSteepest = 0.5f;

// Neighbouring planes differ a little, and so do the cells in them: disks reach this much beyond.
constexpr float kOverlap = 1.1f;

// A point is isolated if its last stored neighbour is this many times farther than is usual among its neighbours.
constexpr float kIsolated = 4;
// ... or, as isolated points may have one another for neighbours, if its disk is this many times the size below which
// this share of all are.
constexpr float kLargest = 3;
constexpr double kLargestShare = 0.99;
constexpr std::size_t kSample = 1 << 17;  // about this many tell what is usual

// A disk at a border has nothing to reach on one side: it goes no farther than this neighbour.
constexpr std::size_t kBorderNeighbour = 4;

struct Plane {
    Vec3f normal;
    bool is_line = false;
};

struct FoundPoint {
    CloudDisk disk{};
    bool border = false;
};

class Estimator {
  public:
    Estimator(const UnitCloud& cloud, const CloudOptions& options)
        : points_(cloud.positions),
          normals_(cloud.normals),
          search_(cloud.positions),
          k_(static_cast<unsigned>(options.neighbours != 0 ? options.neighbours : usual_neighbours())) {
        surface_.plane_neighbours = static_cast<int>(k_);
    }

    CloudSurface estimate(const Progress& progress) {
        surface_.disks = large_vector<CloudDisk>(points_.size());
        surface_.neighbours = large_vector<StoredNeighbours>(points_.size());
        reach_ = large_vector<float>(points_.size());
        // Some steps for the progress, each of many blocks for the threads.
        constexpr std::size_t kSteps = 50;
        for (std::size_t step = 0; step < kSteps; ++step) {
            if (progress) progress("surface", static_cast<double>(step) / kSteps);
            const std::size_t begin = search_.blocks() * step / kSteps, end = search_.blocks() * (step + 1) / kSteps;
            tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 64),
                              [&](const tbb::blocked_range<std::size_t>& range) { estimate_blocks(range); });
        }
        shrink_isolated();
        surface_.border_points = border_points_;
        surface_.isolated_points = isolated_points_;
        surface_.estimated_normals = estimated_normals_;
        return std::move(surface_);
    }

  private:
    int usual_neighbours() const {
        if (!normals_.empty()) return kUsualNeighbours;
        NeighbourSearch::Lists lists;
        Vicinity vicinity;
        std::size_t points = 0, spatial = 0;
        for (std::size_t block = 0; block < search_.blocks(); block += search_.blocks() / kSampledBlocks + 1) {
            search_.find(block, kUsualNeighbours, lists);
            const std::size_t first = block * NeighbourSearch::kBlock;
            for (std::size_t q = 0; q < NeighbourSearch::kBlock && first + q < points_.size(); ++q) {
                look_around(first + q, lists.of(q), vicinity);
                const LeastSpread found = spread_of(vicinity, kUsualNeighbours);
                ++points;
                spatial += found.least > kSpatial * kSpatial * found.middle;
            }
        }
        const bool noisy = static_cast<double>(spatial) > kSpatialPoints * static_cast<double>(points);
        return noisy ? kNoisyNeighbours : kUsualNeighbours;
    }

    void estimate_blocks(const tbb::blocked_range<std::size_t>& blocks) {
        NeighbourSearch::Lists lists, more;
        Vicinity vicinity;
        std::uint64_t borders = 0, estimated = 0;
        for (std::size_t block = blocks.begin(); block < blocks.end(); ++block) {
            search_.find(block, std::max(k_, static_cast<unsigned>(kStoredNeighbours)), lists);
            const std::size_t first = block * NeighbourSearch::kBlock;
            // Points whose nearest neighbours do not suffice, which are asked for again together.
            std::uint32_t insufficient = 0;
            for (std::size_t q = 0; q < NeighbourSearch::kBlock && first + q < points_.size(); ++q) {
                look_around(first + q, lists.of(q), vicinity);
                store(first + q, vicinity);
                bool enough = true;
                Vec3f normal = given_normal(first + q);
                if (normal == Vec3f::Zero()) {
                    const Plane plane = fit_plane(vicinity, k_);
                    normal = plane.normal;
                    enough = !plane.is_line;
                    ++estimated;
                }
                if (enough) {
                    const FoundPoint result = cover_cell(normal, vicinity);
                    surface_.disks[first + q] = result.disk;
                    // A gap as wide as the nearest neighbours are far may have a far side.
                    enough = !result.border;
                }
                insufficient |= static_cast<std::uint32_t>(!enough) << q;
            }
            if (insufficient == 0) continue;
            search_.find(block, kMoreNeighbours * k_, more, insufficient);
            for (; insufficient != 0; insufficient &= insufficient - 1) {
                const auto q = static_cast<std::size_t>(std::countr_zero(insufficient));
                borders += estimate_from_more(first + q, lists.of(q), more.of(q), vicinity);
            }
        }
        border_points_ += borders;
        estimated_normals_ += estimated;
    }

    /// True if the point is at a border.
    bool estimate_from_more(std::size_t point, std::span<const Neighbour> nearest, std::span<const Neighbour> more,
                            Vicinity& vicinity) {
        Vec3f normal = given_normal(point);
        if (normal == Vec3f::Zero()) {
            look_around(point, nearest, vicinity);
            const Plane plane = fit_plane(vicinity, k_);
            normal = plane.normal;
            look_around(point, more, vicinity);
            if (plane.is_line) normal = fit_plane(vicinity, more.size()).normal;
        } else {
            look_around(point, more, vicinity);
        }
        const FoundPoint result = cover_cell(normal, vicinity);
        surface_.disks[point] = result.disk;
        return result.border;
    }

    Vec3f given_normal(std::size_t point) const { return normals_.empty() ? Vec3f(Vec3f::Zero()) : normals_[point]; }

    void look_around(std::size_t point, std::span<const Neighbour> list, Vicinity& vicinity) const {
        std::size_t count = 0;
        const Vec3f centre = points_[point];
        for (; count < list.size() && list[count] != kNoNeighbour; ++count) {
            const std::uint32_t index = index_of(list[count]);
            const Vec3f& other = points_[index];
            vicinity.index[count] = index;
            vicinity.x[count] = other.x() - centre.x();
            vicinity.y[count] = other.y() - centre.y();
            vicinity.z[count] = other.z() - centre.z();
        }
        vicinity.count = count;
        for (; count % Vicinity::kStep != 0; ++count)
            vicinity.x[count] = vicinity.y[count] = vicinity.z[count] = 0;
    }

    void store(std::size_t point, const Vicinity& vicinity) {
        StoredNeighbours& stored = surface_.neighbours[point];
        stored.fill(static_cast<std::uint32_t>(point));
        for (std::size_t i = 0; i < stored.size() && vicinity.count != 0; ++i)
            stored[i] = vicinity.index[std::min(i, vicinity.count - 1)];
        reach_[point] = (points_[stored.back()] - points_[point]).norm();
    }

    // How the point and its nearest neighbours spread.
    LeastSpread spread_of(const Vicinity& vicinity, std::size_t most) const {
        const std::size_t neighbours = std::min(most, vicinity.count);
        const Moments m = functions_.moments(vicinity, neighbours);
        const double count = static_cast<double>(neighbours + 1);
        const auto spread = [&](float product, float a, float b) {
            return (static_cast<double>(product) - static_cast<double>(a) * static_cast<double>(b) / count) / count;
        };
        Eigen::Matrix3d covariance;  // its upper half
        covariance << spread(m.xx, m.x, m.x), spread(m.xy, m.x, m.y), spread(m.xz, m.x, m.z), 0, spread(m.yy, m.y, m.y),
            spread(m.yz, m.y, m.z), 0, 0, spread(m.zz, m.z, m.z);
        return least_spread(covariance);
    }

    // Across the direction in which they spread least.
    Plane fit_plane(const Vicinity& vicinity, std::size_t most) const {
        const LeastSpread found = spread_of(vicinity, most);
        Plane plane;
        plane.is_line = found.middle <= kLineShare * kLineShare * found.most;
        plane.normal = found.direction.cast<float>();
        return plane;
    }

    FoundPoint cover_cell(const Vec3f& normal, const Vicinity& vicinity) const {
        FoundPoint result;
        result.disk.normal = normal;
        if (vicinity.count == 0) {
            result.disk.radius = kLonelyRadius;
            result.border = true;
            return result;
        }
        const CellPlane plane{normal, tangents_of({normal.x(), normal.y(), normal.z()}), kSteepest};
        // Beyond the last neighbour nothing is known.
        const float known = vicinity.distance(vicinity.count - 1);
        const SmallCell cell = vicinity.count <= Vicinity::kStep ? functions_.small_cell(vicinity, plane, known)
                                                                 : large_cell(vicinity, plane, known);
        result.border = !cell.is_bounded;
        const std::size_t last = result.border ? std::min(kBorderNeighbour, vicinity.count - 1) : vicinity.count - 1;
        float radius = std::min(cell.reach * kOverlap, vicinity.distance(last));
        // No corner at all: a line of points, or two.
        if (radius == 0) radius = vicinity.distance(0) / 2 * kOverlap;
        result.disk.radius = radius;
        // Half-way to a neighbour the surface has risen half as far.
        result.disk.above = std::min(cell.above / 2, radius);
        result.disk.below = std::min(cell.below / 2, radius);
        return result;
    }

    static SmallCell large_cell(const Vicinity& vicinity, const CellPlane& plane, float limit) {
        const auto& [s, t] = plane.frame;
        VoronoiCell cell(limit);
        for (std::uint32_t i = 0; i < vicinity.count; ++i) {
            const Vec3f offset = vicinity.offset(i);
            const Eigen::Vector2f projected(offset.x() * s[0] + offset.y() * s[1] + offset.z() * s[2],
                                            offset.x() * t[0] + offset.y() * t[1] + offset.z() * t[2]);
            if (projected.squaredNorm() > plane.least_cosine * plane.least_cosine * offset.squaredNorm())
                cell.cut(projected, i);
        }
        SmallCell result;
        result.reach = cell.reach(true);
        result.is_bounded = cell.is_bounded();
        cell.neighbours([&](std::uint32_t i) {
            const float height = vicinity.offset(i).dot(plane.normal);
            result.above = std::max(result.above, height);
            result.below = std::max(result.below, -height);
        });
        return result;
    }

    // A bird over a lidar tile must not become a cloud as wide as its distance from the ground.
    void shrink_isolated() {
        // Points side by side are near each other, so that every so many are a fair sample.
        std::vector<float> sample;
        for (std::size_t point = 0; point < points_.size(); point += points_.size() / kSample + 1)
            sample.push_back(surface_.disks[point].radius);
        const auto quantile = [&](double share) {
            const auto place =
                sample.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sample.size() - 1));
            std::nth_element(sample.begin(), place, sample.end());
            return *place;
        };
        const float largest = kLargest * quantile(kLargestShare), usual = quantile(0.5);
        std::vector<float> radii = large_vector<float>(points_.size());
        tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t point) {
            radii[point] = surface_.disks[point].radius;
            const StoredNeighbours& stored = surface_.neighbours[point];
            constexpr std::size_t kMiddle = kStoredNeighbours / 2;
            // Farther than the median: than so many.
            std::size_t nearer = 0;
            for (const std::uint32_t neighbour : stored)
                nearer += reach_[point] > kIsolated * reach_[neighbour];
            const bool too_large = radii[point] > largest;
            if (!too_large && nearer <= kMiddle) return;
            std::array<float, kStoredNeighbours> around;
            for (std::size_t i = 0; i < kStoredNeighbours; ++i)
                around[i] = surface_.disks[stored[i]].radius;
            std::nth_element(around.begin(), around.begin() + kMiddle, around.end());
            radii[point] = std::min({radii[point], around[kMiddle], too_large ? usual : radii[point]});
            ++isolated_points_;
        });
        tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t point) {
            CloudDisk& disk = surface_.disks[point];
            disk.radius = radii[point];
            disk.above = std::min(disk.above, disk.radius);
            disk.below = std::min(disk.below, disk.radius);
        });
    }

    static constexpr float kLonelyRadius = 0.01f;  // of a cloud of one point

    const std::vector<Vec3f>&points_, &normals_;
    VicinityFunctions functions_ = vicinity_functions();
    NeighbourSearch search_;
    unsigned k_;  // neighbours that define a plane
    CloudSurface surface_;
    std::vector<float> reach_;  // distance to the last stored neighbour
    std::atomic<std::uint64_t> border_points_{0}, isolated_points_{0}, estimated_normals_{0};
};

}  // namespace

CloudSurface estimate_surface(const UnitCloud& cloud, const CloudOptions& options, const Progress& progress) {
    return Estimator(cloud, options).estimate(progress);
}

}  // namespace splice
