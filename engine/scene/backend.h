// How splats reach the accumulation: sets of passes that fill the same target and are held to the same pictures.
#pragma once

#include "engine/scene/named.h"

#include <cstdint>

namespace splice {

enum class Backend : std::uint32_t {
    kAuto,    // the fastest on the device that can draw the view
    kSprite,  // point sprites and quads, rasterised: the reference
    kTile,    // compute: splats gathered by screen tile, both surfel passes in one go
};

inline constexpr Names<Backend, 3> kBackendNames{
    {{Backend::kAuto, "auto"}, {Backend::kSprite, "sprite"}, {Backend::kTile, "tile"}}};

constexpr std::string_view name_of(Backend backend) {
    return name_in(kBackendNames, backend);
}

}  // namespace splice
