// Fewer splats for the surfels of a patch, for views from so far that several of them fall on a fraction of a pixel:
// what a frame costs follows the pixels that a model covers, not its surfels. As mip maps, made once from what is
// finer. Where a patch is seen from decides (draw_list.h), before any backend, so all of them draw the same.
//
// A few consecutive surfels (files keep neighbours together) that lie closer together than most become one disk in
// their middle, which holds their disks: nothing is left open that they close. Its normal, shading normal and colour
// are their means by area. It is solid as far as their solids reach along its normal (how far tilted
// ones lean sideways is not counted); of flat disks it is flat, as their tilt, over a
// fraction of a pixel, is less than anybody sees. Disks that a line cuts, and such whose normals differ, stay as they
// are.
#pragma once

#include "preprocess/model_format/model_format.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Pixels of MergedRange::growth, unless somebody says otherwise.
inline constexpr double kMergePixels = 0.5, kMostMergePixels = 64;

/// What stands for a patch.
struct MergedRange {
    std::uint64_t first = 0;  // of MergedSurfels::records
    std::uint32_t count = 0;  // 0: nothing does
    // Unit-box units: no surfel's centre moves farther, no disk is larger by more than any that it holds, and no rim
    // leaves its plane by more.
    float growth = 0;
};

struct MergedSurfels {
    std::vector<format::Surfel> records;           // level by level, by patch
    std::vector<std::vector<MergedRange>> levels;  // finest first, a range for each patch
};

/// Deterministic for any thread count.
MergedSurfels merge_surfels(std::span<const format::Surfel> surfels, std::span<const format::Patch> patches);

}  // namespace splice
