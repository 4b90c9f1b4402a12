// Which representation of a model is drawn, whatever its bake chose.
#pragma once

#include "engine/scene/named.h"

#include <cstdint>

namespace splice {

enum class Shown : std::uint32_t {
    kHybrid,     // as baked
    kTriangles,  // surfel patches, too, by the triangles that they were sampled from
    kSurfels,    // surfel patches alone
};

inline constexpr Names<Shown, 3> kShownNames{{{Shown::kHybrid, "hybrid", "as baked"},
                                              {Shown::kTriangles, "triangles", "every patch by its triangles"},
                                              {Shown::kSurfels, "surfels", "surfel patches alone"}}};

constexpr std::string_view name_of(Shown shown) {
    return name_in(kShownNames, shown);
}

}  // namespace splice
