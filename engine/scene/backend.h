// How splats reach the accumulation: sets of passes that fill the same target and are held to the same pictures.
#pragma once

#include "engine/scene/named.h"

#include <cstdint>

namespace splice {

enum class Backend : std::uint32_t {
    kAuto,    // the fastest on the device, group of surfels by group
    kSprite,  // point sprites and quads, rasterised: the reference
    kRaster,  // a primitive a splat, fitted to it, from a list that a compute pass makes
    kTile,    // compute: splats gathered by screen tile, both surfel passes in one go
    kPoint,   // compute: small splats scattered by integer atomics; large ones are rasterised
};

inline constexpr Names<Backend, 5> kBackendNames{{{Backend::kAuto, "auto"},
                                                  {Backend::kSprite, "sprite"},
                                                  {Backend::kRaster, "raster"},
                                                  {Backend::kTile, "tile"},
                                                  {Backend::kPoint, "point"}}};

/// Pixels: no splat that is larger is drawn as a point.
inline constexpr double kLargestPoint = 64;

constexpr std::string_view name_of(Backend backend) {
    return name_in(kBackendNames, backend);
}

}  // namespace splice
