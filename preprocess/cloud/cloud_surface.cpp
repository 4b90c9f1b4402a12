#include "preprocess/cloud/cloud_surface.h"

#include "preprocess/cloud/least_spread.h"
#include "preprocess/cloud/neighbour_search.h"
#include "preprocess/cloud/voronoi_cell.h"
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

// A point's neighbours, the nearest first.
struct Vicinity {
    std::size_t count = 0;
    std::array<std::uint32_t, NeighbourSearch::kMostNeighbours> index;
    std::array<Vec3f, NeighbourSearch::kMostNeighbours> offset;

    std::span<const Vec3f> offsets(std::size_t most) const { return std::span(offset).first(std::min(most, count)); }
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
          k_(static_cast<unsigned>(options.neighbours)),
          search_(cloud.positions) {}

    CloudSurface estimate(const Progress& progress) {
        surface_.disks.resize(points_.size());
        surface_.neighbours.resize(points_.size());
        reach_.resize(points_.size());
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
                    const Plane plane = fit_plane(vicinity.offsets(k_));
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
            const Plane plane = fit_plane(vicinity.offsets(k_));
            normal = plane.normal;
            look_around(point, more, vicinity);
            if (plane.is_line) normal = fit_plane(vicinity.offsets(more.size())).normal;
        } else {
            look_around(point, more, vicinity);
        }
        const FoundPoint result = cover_cell(normal, vicinity);
        surface_.disks[point] = result.disk;
        return result.border;
    }

    Vec3f given_normal(std::size_t point) const { return normals_.empty() ? Vec3f(Vec3f::Zero()) : normals_[point]; }

    void look_around(std::size_t point, std::span<const Neighbour> list, Vicinity& vicinity) const {
        vicinity.count = 0;
        for (const Neighbour neighbour : list) {
            if (neighbour == kNoNeighbour) break;
            vicinity.index[vicinity.count] = index_of(neighbour);
            vicinity.offset[vicinity.count++] = points_[index_of(neighbour)] - points_[point];
        }
    }

    void store(std::size_t point, const Vicinity& vicinity) {
        StoredNeighbours& stored = surface_.neighbours[point];
        stored.fill(static_cast<std::uint32_t>(point));
        for (std::size_t i = 0; i < stored.size() && vicinity.count != 0; ++i)
            stored[i] = vicinity.index[std::min(i, vicinity.count - 1)];
        reach_[point] = (points_[stored.back()] - points_[point]).norm();
    }

    // The direction in which point and neighbours spread least.
    static Plane fit_plane(std::span<const Vec3f> offsets) {
        // Six sums rather than a matrix's nine.
        double x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        for (const Vec3f& offset : offsets) {
            const auto a = static_cast<double>(offset.x()), b = static_cast<double>(offset.y()),
                       c = static_cast<double>(offset.z());
            x += a;
            y += b;
            z += c;
            xx += a * a;
            xy += a * b;
            xz += a * c;
            yy += b * b;
            yz += b * c;
            zz += c * c;
        }
        const double count = static_cast<double>(offsets.size() + 1), square = count * count;
        Eigen::Matrix3d covariance;  // its upper half
        covariance << xx / count - x * x / square, xy / count - x * y / square, xz / count - x * z / square, 0,
            yy / count - y * y / square, yz / count - y * z / square, 0, 0, zz / count - z * z / square;
        const LeastSpread spread = least_spread(covariance);
        Plane plane;
        plane.is_line = spread.middle <= kLineShare * kLineShare * spread.most;
        plane.normal = spread.direction.cast<float>();
        return plane;
    }

    static FoundPoint cover_cell(const Vec3f& normal, const Vicinity& vicinity) {
        FoundPoint result;
        result.disk.normal = normal;
        if (vicinity.count == 0) {
            result.disk.radius = kLonelyRadius;
            result.border = true;
            return result;
        }
        const TangentFrame frame = tangents_of({normal.x(), normal.y(), normal.z()});
        const Vec3f s(frame.s[0], frame.s[1], frame.s[2]), t(frame.t[0], frame.t[1], frame.t[2]);
        const auto distance = [&](std::size_t i) { return vicinity.offset[i].norm(); };
        // Beyond the last neighbour nothing is known.
        VoronoiCell cell(distance(vicinity.count - 1));
        for (std::uint32_t i = 0; i < vicinity.count; ++i) {
            const Vec3f& offset = vicinity.offset[i];
            const Eigen::Vector2f projected(offset.dot(s), offset.dot(t));
            if (projected.squaredNorm() > kSteepest * kSteepest * offset.squaredNorm()) cell.cut(projected, i);
        }
        result.border = !cell.is_bounded();
        const std::size_t last = result.border ? std::min(kBorderNeighbour, vicinity.count - 1) : vicinity.count - 1;
        float radius = std::min(cell.reach(true) * kOverlap, distance(last));
        // No corner at all: a line of points, or two.
        if (radius == 0) radius = distance(0) / 2 * kOverlap;
        result.disk.radius = radius;
        // Half-way to a neighbour the surface has risen half as far.
        cell.neighbours([&](std::uint32_t i) {
            const float height = vicinity.offset[i].dot(normal) / 2;
            result.disk.above = std::max(result.disk.above, height);
            result.disk.below = std::max(result.disk.below, -height);
        });
        result.disk.above = std::min(result.disk.above, radius);
        result.disk.below = std::min(result.disk.below, radius);
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
        std::vector<float> radii(points_.size());
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
    unsigned k_;
    NeighbourSearch search_;
    CloudSurface surface_;
    std::vector<float> reach_;  // distance to the last stored neighbour
    std::atomic<std::uint64_t> border_points_{0}, isolated_points_{0}, estimated_normals_{0};
};

}  // namespace

CloudSurface estimate_surface(const UnitCloud& cloud, const CloudOptions& options, const Progress& progress) {
    return Estimator(cloud, options).estimate(progress);
}

}  // namespace splice
