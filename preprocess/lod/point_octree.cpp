#include "preprocess/lod/point_octree.h"

#include "preprocess/lod/bounding_ellipse.h"
#include "preprocess/lod/homogeneous_covariance.h"
#include "preprocess/lod/split_points.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"

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
// Bounds are stored in single precision; coordinates are below 1.
constexpr double kRounding = 1e-6;
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

    void add(const format::Surfel& surfel) {
        const auto radius = static_cast<double>(float_from_half(surfel.radius));
        const double weight = radius * radius;
        covariance.add(position_of(surfel));
        normal += weight * decoded(surfel.normal);
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

// What is below a node: a disk, or a child with all its disks.
struct Part {
    Vec3d centre, normal;
    Vec3d axes[2];        // half axes
    double longest;       // half axis
    double above, below;  // of a disk, its solid; of a child, how far its disks leave its plane
    double height;        // how far its disks leave its plane: those of a child, whose ellipse holds their projections
    double sphere;        // radius about its centre
    double cone;          // half-angle, radians

    // How far its disks go along `direction`.
    double reach(const Vec3d& direction) const {
        const double in_plane = length_of(axes[0].dot(direction), axes[1].dot(direction));
        return std::min(in_plane + height * std::abs(normal.dot(direction)), sphere);
    }
};

Part part_of(const format::Surfel& surfel) {
    const float radius = float_from_half(surfel.radius);
    const SurfelExtent extent = decode_extent(surfel.extent, radius);
    Part part;
    part.centre = position_of(surfel);
    part.normal = decoded(surfel.normal);
    const TangentFrame frame = tangents_of(decode_octahedral(surfel.normal));
    const auto r = static_cast<double>(radius);
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        part.axes[0][k] = r * static_cast<double>(frame.s[i]);
        part.axes[1][k] = r * static_cast<double>(frame.t[i]);
    }
    part.above = static_cast<double>(extent.above);
    part.below = static_cast<double>(extent.below);
    part.longest = r;
    part.height = 0;
    part.sphere = length_of(r, std::max(part.above, part.below));
    part.cone = 0;
    return part;
}

class Builder {
  public:
    explicit Builder(std::vector<format::Surfel>& surfels) : surfels_(surfels) {}

    std::vector<format::PointNode> build(PointSplit split) {
        reorder(split.order);
        nodes_ = std::move(split.nodes);
        sums_.resize(nodes_.size());
        thickness_.resize(nodes_.size());
        for (std::size_t level = split.level_begin.size() - 1; level-- > 0;) {
            tbb::parallel_for(split.level_begin[level], split.level_begin[level + 1], [&](std::uint32_t index) {
                add_up(index);
                place(index);
                bound(index);
            });
        }
        return std::move(nodes_);
    }

  private:
    void reorder(const std::vector<std::uint32_t>& order) {
        std::vector<format::Surfel> sorted(surfels_.size());
        tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) { sorted[i] = surfels_[order[i]]; });
        surfels_ = std::move(sorted);
    }

    std::span<const format::Surfel> surfels_of(const format::PointNode& node) const {
        return std::span<const format::Surfel>(surfels_).subspan(node.first_surfel, node.surfel_count);
    }

    void add_up(std::uint32_t index) {
        const format::PointNode& node = nodes_[index];
        Sums& sums = sums_[index];
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            sums.add(sums_[node.first_child + child]);
        if (node.child_count != 0) return;
        for (const format::Surfel& surfel : surfels_of(node))
            sums.add(surfel);
    }

    // Position, normal, colour: means.
    void place(std::uint32_t index) {
        format::PointNode& node = nodes_[index];
        const Sums& sums = sums_[index];
        const Vec3d mean = sums.covariance.mean();
        for (int k = 0; k < 3; ++k) {
            node.position[k] = static_cast<float>(mean[k]);
            node.colour[k] = srgb_from_linear(static_cast<float>(sums.colour[k] / sums.area));
        }
        // Normals that cancel out: any will do, the cone will say so.
        const bool usable = sums.normal.norm() > 1e-6 * sums.area;
        node.normal = encoded(usable ? sums.normal : decoded(surfels_[node.first_surfel].normal));
        round_node(node);
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
        part.height = std::max(part.above, part.below);
        part.sphere = static_cast<double>(node.sphere_radius);
        part.cone = node.cone_angle * std::numbers::pi / kConeSteps;
        return part;
    }

    // What the node is bounded by.
    std::vector<Part> parts_of(const format::PointNode& node) const {
        std::vector<Part> parts;
        if (node.child_count != 0 && node.surfel_count > kBoundedByDisks) {
            for (std::uint32_t child = 0; child < node.child_count; ++child)
                parts.push_back(part_of_node(node.first_child + child));
        } else {
            parts.reserve(node.surfel_count);
            for (const format::Surfel& surfel : surfels_of(node))
                parts.push_back(part_of(surfel));
        }
        return parts;
    }

    // Ellipse, sphere, cone and thickness, from what the node stores of position and normal, so that rounding is in.
    void bound(std::uint32_t index) {
        format::PointNode& node = nodes_[index];
        const Vec3d centre(static_cast<double>(node.position[0]), static_cast<double>(node.position[1]),
                           static_cast<double>(node.position[2]));
        const Vec3d normal = decoded(node.normal);
        const TangentFrame frame = tangents_of(decode_octahedral(node.normal));
        const Vec3d s(static_cast<double>(frame.s[0]), static_cast<double>(frame.s[1]),
                      static_cast<double>(frame.s[2]));
        const Vec3d t(static_cast<double>(frame.t[0]), static_cast<double>(frame.t[1]),
                      static_cast<double>(frame.t[2]));
        const Ellipse spread = ellipse_of(sums_[index].covariance.in_plane(centre, s, t));
        node.major_axis = encoded(spread.axis.x() * s + spread.axis.y() * t);
        round_node(node);
        // From here on the axis that is stored; what it leaves the plane by is within the rounding added below.
        const Vec3d major = decoded(node.major_axis), minor = normal.cross(major);

        const std::vector<Part> parts = parts_of(node);
        std::vector<Footprint> footprints;
        footprints.reserve(parts.size());
        double sphere = 0, cosine = 1, cone = 0, above = 0, below = 0, largest_radius = 0;
        for (const Part& part : parts) {
            const Vec3d offset = part.centre - centre;
            footprints.push_back({.x = offset.dot(major),
                                  .y = offset.dot(minor),
                                  .reach_x = part.reach(major),
                                  .reach_y = part.reach(minor),
                                  .radius = std::min(part.longest + part.height, part.sphere)});
            sphere = std::max(sphere, offset.norm() + part.sphere);
            if (part.cone == 0) {
                cosine = std::min(cosine, part.normal.dot(normal));
            } else {
                cone = std::max(cone, std::acos(std::clamp(part.normal.dot(normal), -1.0, 1.0)) + part.cone);
            }
            const double height = offset.dot(normal),
                         slant = length_of(part.axes[0].dot(normal), part.axes[1].dot(normal));
            above = std::max(above, height + slant + part.above);
            below = std::max(below, -height + slant + part.below);
            largest_radius = std::max(largest_radius, part.longest);
        }
        cone = std::max(cone, std::acos(std::clamp(cosine, -1.0, 1.0)));
        const Ellipse ellipse = ellipse_around(footprints);
        const auto length = [](double value) { return static_cast<float>(value * (1 + kRounding) + kRounding); };
        node.major = length(ellipse.major);
        node.minor = length(ellipse.minor);
        node.sphere_radius = length(sphere);
        round_node(node);
        // A thousandth of a radian for the rounding of normals.
        node.cone_angle =
            static_cast<std::uint8_t>(std::min(std::ceil((cone + 1e-3) / std::numbers::pi * kConeSteps), kConeSteps));
        thickness_[index] = {above, below};
        node.extent = encode_extent({static_cast<float>(above), static_cast<float>(below),
                                     static_cast<float>(kEpsilon * largest_radius + above + below)},
                                    node.major);
    }

    std::vector<format::Surfel>& surfels_;
    std::vector<format::PointNode> nodes_;
    std::vector<Sums> sums_;
    struct Thickness {
        double above, below;
    };
    std::vector<Thickness> thickness_;  // what `extent` says, before it is cut to the major axis
};

}  // namespace

std::vector<format::PointNode> build_point_octree(std::vector<format::Surfel>& surfels) {
    if (surfels.empty()) return {};
    return Builder(surfels).build(split_points(surfels));
}

std::vector<format::PointNode> build_patch_point_octree(std::vector<format::Surfel>& surfels,
                                                        std::span<const format::Patch> patches,
                                                        std::span<const format::OctreeNode> octree) {
    if (surfels.empty()) return {};
    return Builder(surfels).build(split_patches(surfels, patches, octree));
}

}  // namespace splice
