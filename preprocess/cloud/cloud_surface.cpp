#include "preprocess/cloud/cloud_surface.h"

#include "preprocess/cloud/neighbour_search.h"
#include "preprocess/cloud/voronoi_cell.h"
#include "preprocess/model_format/tangent_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
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
        std::uint64_t borders = 0, estimated = 0;
        for (std::size_t block = blocks.begin(); block < blocks.end(); ++block) {
            search_.find(block, std::max(k_, static_cast<unsigned>(kStoredNeighbours)), lists);
            const std::size_t first = block * NeighbourSearch::kBlock;
            for (std::size_t q = 0; q < NeighbourSearch::kBlock && first + q < points_.size(); ++q) {
                const std::size_t point = first + q;
                std::span<const Neighbour> found = usable(lists.of(q));
                store(point, found);
                Plane plane;
                if (!normals_.empty() && normals_[point] != Vec3f::Zero()) {
                    plane.normal = normals_[point];
                } else {
                    plane = fit_plane(point, found.first(std::min<std::size_t>(found.size(), k_)));
                    if (plane.is_line) {
                        found = ask_more(block, q, more);
                        plane = fit_plane(point, found);
                    }
                    ++estimated;
                }
                FoundPoint result = cover_cell(point, plane.normal, found);
                // A gap as wide as the nearest neighbours are far may have a far side.
                if (result.border && found.size() <= k_)
                    result = cover_cell(point, plane.normal, ask_more(block, q, more));
                surface_.disks[point] = result.disk;
                borders += result.border;
            }
        }
        border_points_ += borders;
        estimated_normals_ += estimated;
    }

    std::span<const Neighbour> ask_more(std::size_t block, std::size_t q, NeighbourSearch::Lists& more) const {
        search_.find(block, kMoreNeighbours * k_, more, 1u << q);
        return usable(more.of(q));
    }

    static std::span<const Neighbour> usable(std::span<const Neighbour> list) {
        while (!list.empty() && list.back() == kNoNeighbour)
            list = list.first(list.size() - 1);
        return list;
    }

    void store(std::size_t point, std::span<const Neighbour> found) {
        StoredNeighbours& stored = surface_.neighbours[point];
        stored.fill(static_cast<std::uint32_t>(point));
        for (std::size_t i = 0; i < stored.size() && !found.empty(); ++i)
            stored[i] = index_of(found[std::min(i, found.size() - 1)]);
        reach_[point] = (points_[stored.back()] - points_[point]).norm();
    }

    // The direction in which point and neighbours spread least.
    Plane fit_plane(std::size_t point, std::span<const Neighbour> found) const {
        Vec3d sum = Vec3d::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for (const Neighbour neighbour : found) {
            const Vec3d offset = (points_[index_of(neighbour)] - points_[point]).cast<double>();
            sum += offset;
            squares.noalias() += offset * offset.transpose();
        }
        const double count = static_cast<double>(found.size() + 1);
        const Eigen::Matrix3d covariance = squares / count - sum * sum.transpose() / (count * count);
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
        solver.computeDirect(covariance);
        Plane plane;
        const Vec3d normal = solver.eigenvectors().col(0);
        const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0.0);
        plane.is_line = spread[1] <= kLineShare * kLineShare * spread[2];
        plane.normal = normal.allFinite() && normal.norm() > 0.5 ? Vec3f(normal.normalized().cast<float>())
                                                                 : Vec3f(Vec3f::UnitZ());
        return plane;
    }

    FoundPoint cover_cell(std::size_t point, const Vec3f& normal, std::span<const Neighbour> found) const {
        FoundPoint result;
        result.disk.normal = normal;
        if (found.empty()) {
            result.disk.radius = kLonelyRadius;
            result.border = true;
            return result;
        }
        const TangentFrame frame = tangents_of({normal.x(), normal.y(), normal.z()});
        const Vec3f s(frame.s[0], frame.s[1], frame.s[2]), t(frame.t[0], frame.t[1], frame.t[2]);
        const auto offset_of = [&](Neighbour neighbour) {
            return Vec3f(points_[index_of(neighbour)] - points_[point]);
        };
        // Beyond the last neighbour nothing is known.
        const float limit = offset_of(found.back()).norm();
        VoronoiCell cell(limit);
        for (std::uint32_t i = 0; i < found.size(); ++i) {
            const Vec3f offset = offset_of(found[i]);
            const Eigen::Vector2f projected(offset.dot(s), offset.dot(t));
            if (projected.squaredNorm() > kSteepest * kSteepest * offset.squaredNorm()) cell.cut(projected, i);
        }
        result.border = !cell.is_bounded();
        const std::size_t last = result.border ? std::min(kBorderNeighbour, found.size() - 1) : found.size() - 1;
        float radius = std::min(cell.reach(true) * kOverlap, offset_of(found[last]).norm());
        // No corner at all: a line of points, or two.
        if (radius == 0) radius = offset_of(found.front()).norm() / 2 * kOverlap;
        result.disk.radius = radius;
        // Half-way to a neighbour the surface has risen half as far.
        cell.neighbours([&](std::uint32_t i) {
            const float height = offset_of(found[i]).dot(normal) / 2;
            result.disk.above = std::max(result.disk.above, height);
            result.disk.below = std::max(result.disk.below, -height);
        });
        result.disk.above = std::min(result.disk.above, radius);
        result.disk.below = std::min(result.disk.below, radius);
        return result;
    }

    // A bird over a lidar tile must not become a cloud as wide as its distance from the ground.
    void shrink_isolated() {
        std::vector<float> radii(points_.size());
        tbb::parallel_for(std::size_t{0}, points_.size(),
                          [&](std::size_t point) { radii[point] = surface_.disks[point].radius; });
        const auto quantile = [&](double share) {
            const auto place =
                radii.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(radii.size() - 1));
            std::nth_element(radii.begin(), place, radii.end());
            return *place;
        };
        const float largest = kLargest * quantile(kLargestShare), usual = quantile(0.5);
        tbb::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t point) {
            const StoredNeighbours& stored = surface_.neighbours[point];
            std::array<float, kStoredNeighbours> reaches, around;
            for (std::size_t i = 0; i < kStoredNeighbours; ++i) {
                reaches[i] = reach_[stored[i]];
                around[i] = surface_.disks[stored[i]].radius;
            }
            constexpr std::size_t kMiddle = kStoredNeighbours / 2;
            std::nth_element(reaches.begin(), reaches.begin() + kMiddle, reaches.end());
            radii[point] = surface_.disks[point].radius;
            const bool too_large = radii[point] > largest;
            if (!too_large && reach_[point] <= kIsolated * reaches[kMiddle]) return;
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
