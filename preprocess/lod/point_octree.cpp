#include "preprocess/lod/point_octree.h"

#include "preprocess/large_vector.h"
#include "preprocess/lod/bounding_ellipse.h"
#include "preprocess/lod/disk_bounds.h"
#include "preprocess/lod/homogeneous_covariance.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace splice {
namespace {

// Larger nodes are bounded by their children.
constexpr std::uint32_t kBoundedByDisks = 512;
constexpr double kConeSteps = 255;
// Bounds are computed and stored in single precision; coordinates are below 1.
constexpr double kRounding = 4e-6;
// Of a surfel, cloud_surface.h.
constexpr double kEpsilon = 1.5;

Vec3d decoded(std::uint32_t octahedral) {
    const auto v = decode_octahedral(octahedral);
    return Vec3d(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

std::uint32_t encoded(const Vec3d& v) {
    return encode_octahedral(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
}

// What adds up from the surfels to the root.
struct Sums {
    HomogeneousCovariance covariance;
    Vec3d normal = Vec3d::Zero(), colour = Vec3d::Zero();  // weighted by area
    double area = 0;

    void add(const format::Surfel& surfel, const Vec3f& unit_normal, float radius) {
        const double weight = static_cast<double>(radius) * static_cast<double>(radius);
        covariance.add(position_of(surfel).cast<double>());
        normal += weight * unit_normal.cast<double>();
        for (int c = 0; c < 3; ++c)
            colour[c] += weight * static_cast<double>(linear_from_srgb(surfel.colour[c]));
        area += weight;
    }
    void add(const Sums& other) {
        covariance += other.covariance;
        normal += other.normal;
        colour += other.colour;
        area += other.area;
    }
};

// A child with all its disks.
struct Part {
    Vec3d centre, normal;
    Vec3d axes[2];        // half axes
    double longest;       // half axis
    double above, below;  // how far its disks leave its plane
    double sphere;        // radius about its centre
    double cone;          // half-angle, radians

    // How far its disks, whose projections its ellipse holds, leave its plane.
    double height() const { return std::max(above, below); }
    // How far its disks go along `direction`.
    double reach(const Vec3d& direction) const {
        const double in_plane = length_of(axes[0].dot(direction), axes[1].dot(direction));
        return std::min(in_plane + height() * std::abs(normal.dot(direction)), sphere);
    }
};

// What bounds a node, before rounding.
struct NodeBounds {
    double sphere = 0, cone = 0, above = 0, below = 0, largest_radius = 0, major = 0, minor = 0;
};

class Builder {
  public:
    /// In the order of `split`.
    Builder(std::span<const format::Surfel> surfels, PointSplit split)
        : surfels_(surfels), nodes_(std::move(split.nodes)), level_begin_(std::move(split.level_begin)) {}

    std::vector<format::PointNode> build() {
        const std::vector<std::uint32_t> small = small_roots();
        // Nodes are breadth first: of those below all small roots nobody asks.
        sums_.resize(small.back() + 1);
        thickness_.resize(small.back() + 1);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, small.size()),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              DiskArrays disks;
                              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                                  disks.clear();
                                  sums_[small[i]] = finish_small(small[i], disks);
                              }
                          });
        for (std::size_t level = level_begin_.size() - 1; level-- > 0;) {
            tbb::parallel_for(level_begin_[level], level_begin_[level + 1], [&](std::uint32_t index) {
                if (!is_small(index)) finish_large(index);
            });
        }
        return std::move(nodes_);
    }

  private:
    std::span<const format::Surfel> surfels_of(const format::PointNode& node) const {
        return surfels_.subspan(node.first_surfel, node.surfel_count);
    }

    bool is_small(std::uint32_t index) const {
        return nodes_[index].child_count == 0 || nodes_[index].surfel_count <= kBoundedByDisks;
    }

    // The highest nodes that are bounded by disks.
    std::vector<std::uint32_t> small_roots() const {
        std::vector<std::uint32_t> roots;
        if (is_small(0)) return {0};
        for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
            if (is_small(index)) continue;
            for (std::uint32_t child = 0; child < nodes_[index].child_count; ++child)
                if (is_small(nodes_[index].first_child + child)) roots.push_back(nodes_[index].first_child + child);
        }
        return roots;
    }

    // A node and all below it; its disks are appended to `disks`.
    Sums finish_small(std::uint32_t index, DiskArrays& disks) {
        const format::PointNode& node = nodes_[index];
        const std::size_t begin = disks.size();
        Sums sums;
        if (node.child_count == 0) {
            for (const format::Surfel& surfel : surfels_of(node)) {
                disks.add(surfel);
                sums.add(surfel, disks.normal(disks.size() - 1), disks.radius(disks.size() - 1));
            }
            disks.fill_step();
        } else {
            for (std::uint32_t child = 0; child < node.child_count; ++child)
                sums.add(finish_small(node.first_child + child, disks));
        }
        place(index, sums);
        const Axes axes = choose_axes(index, sums);
        const DiskBounds disk = bound_disks(
            disks, begin, disks.size(),
            {axes.centre.cast<float>(), axes.normal.cast<float>(), axes.major.cast<float>(), axes.minor.cast<float>()});
        const auto exact = [](float value) { return static_cast<double>(value); };
        store_bounds(index, {.sphere = exact(disk.sphere),
                             .cone = std::acos(std::clamp(exact(disk.cosine), -1.0, 1.0)),
                             .above = exact(disk.above),
                             .below = exact(disk.below),
                             .largest_radius = exact(disk.largest_radius),
                             .major = exact(disk.major),
                             .minor = exact(disk.minor)});
        return sums;
    }

    void finish_large(std::uint32_t index) {
        const format::PointNode& node = nodes_[index];
        Sums& sums = sums_[index];
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            sums.add(sums_[node.first_child + child]);
        place(index, sums);
        store_bounds(index, bounds_from_children(index, choose_axes(index, sums)));
    }

    // Position, normal, colour: means.
    void place(std::uint32_t index, const Sums& sums) {
        format::PointNode& node = nodes_[index];
        const Vec3d mean = sums.covariance.mean();
        for (int k = 0; k < 3; ++k) {
            node.position[k] = static_cast<float>(mean[k]);
            node.colour[k] = srgb_from_linear(static_cast<float>(sums.colour[k] / sums.area));
        }
        // Normals that cancel out: any will do, the cone will say so.
        const bool usable = sums.normal.norm() > 1e-6 * sums.area;
        node.normal = encoded(usable ? sums.normal : decoded(surfels_[node.first_surfel].normal));
        round_place(node);
    }

    // Of a node that has been bounded.
    Part part_of_node(std::uint32_t index) const {
        const format::PointNode& node = nodes_[index];
        Part part;
        part.centre = {static_cast<double>(node.position[0]), static_cast<double>(node.position[1]),
                       static_cast<double>(node.position[2])};
        part.normal = decoded(node.normal);
        const Vec3d axis = decoded(node.major_axis);
        part.axes[0] = static_cast<double>(node.major) * axis;
        part.axes[1] = static_cast<double>(node.minor) * part.normal.cross(axis);
        part.above = thickness_[index].above;
        part.below = thickness_[index].below;
        part.longest = static_cast<double>(node.major);
        part.sphere = static_cast<double>(node.sphere_radius);
        part.cone = node.cone_angle * std::numbers::pi / kConeSteps;
        return part;
    }

    struct Axes {
        Vec3d centre, normal, major, minor;
    };

    // From what the node stores of position and normal, so that rounding is in.
    Axes choose_axes(std::uint32_t index, const Sums& sums) {
        format::PointNode& node = nodes_[index];
        Axes axes;
        for (int k = 0; k < 3; ++k)
            axes.centre[k] = static_cast<double>(node.position[k]);
        axes.normal = decoded(node.normal);
        const TangentFrame frame = tangents_of(decode_octahedral(node.normal));
        const Vec3d s(static_cast<double>(frame.s[0]), static_cast<double>(frame.s[1]),
                      static_cast<double>(frame.s[2]));
        const Vec3d t(static_cast<double>(frame.t[0]), static_cast<double>(frame.t[1]),
                      static_cast<double>(frame.t[2]));
        const Ellipse spread = ellipse_of(sums.covariance.in_plane(axes.centre, s, t));
        node.major_axis = encoded(spread.axis.x() * s + spread.axis.y() * t);
        round_axis(node);
        // From here on the axis that is stored; what it leaves the plane by is within the rounding added below.
        axes.major = decoded(node.major_axis);
        axes.minor = axes.normal.cross(axes.major);
        return axes;
    }

    NodeBounds bounds_from_children(std::uint32_t index, const Axes& axes) const {
        const format::PointNode& node = nodes_[index];
        std::vector<Footprint> footprints;
        footprints.reserve(node.child_count);
        NodeBounds bounds;
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
            const Part part = part_of_node(node.first_child + child);
            const Vec3d offset = part.centre - axes.centre;
            footprints.push_back({.x = offset.dot(axes.major),
                                  .y = offset.dot(axes.minor),
                                  .reach_x = part.reach(axes.major),
                                  .reach_y = part.reach(axes.minor),
                                  .radius = std::min(part.longest + part.height(), part.sphere)});
            bounds.sphere = std::max(bounds.sphere, offset.norm() + part.sphere);
            bounds.cone =
                std::max(bounds.cone, std::acos(std::clamp(part.normal.dot(axes.normal), -1.0, 1.0)) + part.cone);
            const double height = offset.dot(axes.normal),
                         slant = length_of(part.axes[0].dot(axes.normal), part.axes[1].dot(axes.normal));
            bounds.above = std::max(bounds.above, height + slant + part.above);
            bounds.below = std::max(bounds.below, -height + slant + part.below);
            bounds.largest_radius = std::max(bounds.largest_radius, part.longest);
        }
        const Ellipse ellipse = ellipse_around(footprints);
        bounds.major = ellipse.major;
        bounds.minor = ellipse.minor;
        return bounds;
    }

    void store_bounds(std::uint32_t index, const NodeBounds& bounds) {
        format::PointNode& node = nodes_[index];
        const auto length = [](double value) { return static_cast<float>(value * (1 + kRounding) + kRounding); };
        node.major = length(bounds.major);
        node.minor = length(bounds.minor);
        node.sphere_radius = length(bounds.sphere);
        round_lengths(node);
        // A thousandth of a radian for the rounding of normals.
        node.cone_angle = static_cast<std::uint8_t>(
            std::min(std::ceil((bounds.cone + 1e-3) / std::numbers::pi * kConeSteps), kConeSteps));
        if (index < thickness_.size()) thickness_[index] = {bounds.above, bounds.below};
        node.extent =
            encode_extent({static_cast<float>(bounds.above), static_cast<float>(bounds.below),
                           static_cast<float>(kEpsilon * bounds.largest_radius + bounds.above + bounds.below)},
                          node.major);
    }

    std::span<const format::Surfel> surfels_;
    std::vector<format::PointNode> nodes_;
    std::vector<std::uint32_t> level_begin_;
    std::vector<Sums> sums_;  // of large nodes and small roots
    struct Thickness {
        double above, below;
    };
    std::vector<Thickness> thickness_;  // of the same: what `extent` says, before it is cut to the major axis
};

void reorder(std::vector<format::Surfel>& surfels, const std::vector<std::uint32_t>& order) {
    std::vector<format::Surfel> sorted = large_vector<format::Surfel>(surfels.size());
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) { sorted[i] = surfels[order[i]]; });
    surfels = std::move(sorted);
}

std::vector<format::PointNode> build(std::vector<format::Surfel>& surfels, PointSplit split) {
    reorder(surfels, split.order);
    return bound_point_octree(surfels, std::move(split));
}

}  // namespace

std::vector<format::PointNode> build_point_octree(std::vector<format::Surfel>& surfels) {
    if (surfels.empty()) return {};
    return build(surfels, split_points(positions_of(surfels)));
}

std::vector<format::PointNode> bound_point_octree(std::span<const format::Surfel> surfels, PointSplit split) {
    if (surfels.empty()) return {};
    return Builder(surfels, std::move(split)).build();
}

std::vector<format::PointNode> build_patch_point_octree(std::vector<format::Surfel>& surfels,
                                                        std::span<const format::Patch> patches,
                                                        std::span<const format::OctreeNode> octree) {
    if (surfels.empty()) return {};
    return build(surfels, split_patches(surfels, patches, octree));
}

}  // namespace splice
