// A node of the point octree (Pajarola et al. 2004, sections 3.2 and 4): an elliptical splat that stands for all
// surfels below it. In files, format::PackedPointNode: breadth first, and children divide their parent's surfels in
// order, so that ranges and links follow from counts.
//
// What packing does to a node:
//   position    3 x 20 bits over -0.5..0.5: within 2^-21
//   normal      octahedral, 2 x 12 bits: within 0.06 degrees
//   major axis  one of 256 directions in half a turn, from s towards t of tangents_of(normal): within 0.36 degrees
//   lengths     halves, rounded up: larger by less than 0.1 % or 6e-8; the minor axis by less than 1/255 of the major
//   one
// Whoever bounds something by a node rounds its place and frame first, then bounds, then rounds the lengths up.
#pragma once

#include "preprocess/model_format/model_format.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

namespace format {

struct PointNode {
    float position[3];         // mean of the surfels' centres; centre of ellipse and sphere
    float sphere_radius;       // every disk below it, its solid included, is in this sphere
    std::uint32_t normal;      // octahedral; of the ellipse's plane and axis of the normal cone
    std::uint32_t major_axis;  // octahedral; in the plane, up to rounding
    float major, minor;        // half axes: projected to the plane, every disk below it is in the ellipse
    std::uint8_t colour[3];    // sRGB; mean over the disks' areas in linear light
    std::uint8_t cone_angle;  // half-angle of a cone about `normal` that holds every normal below it, steps of pi / 255
    std::uint16_t extent;     // surfel_extent.h, with `major` as the radius
    std::uint8_t child_count;    // 0: a leaf, whose children are its surfels
    std::uint32_t first_child;   // 0 in a leaf
    std::uint32_t first_surfel;  // surfels [first_surfel, first_surfel + surfel_count) are below it
    std::uint32_t surfel_count;
};

}  // namespace format

/// The most surfels that a leaf may have.
inline constexpr std::uint32_t kMostLeafSurfels = 127;

/// Parts of a node as packing leaves them: position and normal; the major axis, once the normal is rounded; the
/// lengths. Rounding again changes nothing.
void round_place(format::PointNode& node);
void round_axis(format::PointNode& node);
void round_lengths(format::PointNode& node);

format::PackedPointNode pack_point_node(const format::PointNode& node);

/// Of rounded nodes in the order of a file.
std::vector<format::PackedPointNode> pack_point_tree(std::span<const format::PointNode> nodes);

/// Of a tree that a reader has checked: links, ranges and all.
std::vector<format::PointNode> unpack_point_tree(std::span<const format::PackedPointNode> packed);

}  // namespace splice
