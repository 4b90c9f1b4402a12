// The surfel model of the frame benchmark, made without a bake: a sphere with bumps, sampled on a Fibonacci lattice and
// stored in Morton order.
#pragma once

#include "preprocess/model_format/model.h"

#include <cstdint>

namespace splice::bench {

/// The surface of shapes::bumpy_radius; every point of it lies under about `depth` of the `count` disks. Positions are
/// source units.
Model bumpy_sphere(std::uint32_t count, double depth);

}  // namespace splice::bench
