// Where light is computed.
#pragma once

#include "engine/scene/named.h"

#include <cstdint>

namespace splice {

enum class Shading : std::uint32_t {
    kSurfel,    // at surfels, to first order; colours are blended
    kDeferred,  // at pixels: normals and albedos are blended, then lit once (Botsch et al. 2005)
};

inline constexpr Names<Shading, 2> kShadingNames{{{Shading::kSurfel, "surfel"}, {Shading::kDeferred, "deferred"}}};

constexpr std::string_view name_of(Shading shading) {
    return name_in(kShadingNames, shading);
}

}  // namespace splice
