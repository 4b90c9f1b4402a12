// The surfel model of the frame benchmark, made without a bake: a sphere with bumps, sampled on a Fibonacci lattice and
// stored in Morton order.
#pragma once

#include "preprocess/model_format/model.h"

#include <cstdint>

namespace splice::bench {

/// Every point of the surface lies under about `depth` of the `count` disks. Positions are source units: the radius is
/// r = 1 + 0.06 sin 7x sin(7y+1) sin(7z+2) + 0.01 sin(31x+17y) sin 29z in the direction (x, y, z).
Model bumpy_sphere(std::uint32_t count, double depth);

}  // namespace splice::bench
