// A node of the point tree as a record that every surfel pass reads: format::Surfel with two fields read in another
// way, so that ellipses and disks stand side by side in one buffer.
//   radius  below 0: an ellipse, whose major half axis is its absolute value
//   clip    of an ellipse, its axes: bits 0..7 the direction of the major one, in 256ths of half a turn from s to t
//           (tangents_of(normal)); bits 8..15 minor over major, in 255ths
// Both are rounded so that the record's ellipse holds the node's. The `extent` of a node already is in shares of its
// major half axis. shaders/glsl/include/surfel_frame.glsl decodes the same.
#pragma once

#include "preprocess/model_format/point_node.h"

#include <cstdint>

namespace splice {

inline constexpr int kAxisDirections = 256;  // in half a turn
inline constexpr int kAxisSteps = 255;

struct EllipseAxes {
    double major = 0, minor = 0;  // half axes, unit-box units
    double turn = 0;              // of the major one, radians from s to t, 0..pi
};

/// `patch`: what Surfel::patch is to hold.
format::Surfel ellipse_record(const format::PointNode& node, std::uint16_t patch);

bool is_ellipse_record(const format::Surfel& record);

/// Of an ellipse's record.
EllipseAxes ellipse_axes(const format::Surfel& record);

}  // namespace splice
