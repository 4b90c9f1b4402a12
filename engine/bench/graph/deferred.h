// How many passes of each kind a view of the deferred family has, which its twin written by hand shares.
#pragma once

#include <algorithm>
#include <cstdint>

namespace splice::bench {

struct DeferredView {
    uint32_t lights = 0;        ///< each a shadow map and a pass that adds its light
    uint32_t bloom_levels = 0;  ///< each a pass down and a pass up
    bool blur_occlusion = false;

    /// G-buffer, occlusion, ambient light and tone mapping; then up to 4 levels of bloom; all else are lights. At least
    /// 4 passes.
    static constexpr DeferredView of(uint32_t passes) {
        const uint32_t pairs = (passes - 4) / 2;
        const uint32_t bloom = std::min(pairs, 4U);
        return {pairs - bloom, bloom, passes % 2 != 0};
    }
};

inline constexpr uint32_t kShadowMapSize = 1024;  ///< pixels a side, at most: views smaller than that have smaller ones

}  // namespace splice::bench
