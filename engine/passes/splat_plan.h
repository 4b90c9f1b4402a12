// Which technique draws which surfels, and how a frame's surfels are cut into batches that fit the buffers.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/scene/backend.h"
#include "engine/scene/draw_list.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <vector>

namespace splice {

/// How compute passes get splats to the accumulation; see Backend.
enum class Technique : std::uint32_t { kTile, kRaster, kPoint };
inline constexpr std::size_t kTechniques = 3;

Backend backend_of(Technique technique);

/// By list of the draws: the small splats, and the others.
struct Techniques {
    Technique small = Technique::kTile, others = Technique::kTile;
};

/// Surfels that one workgroup of setup works on: at most kTileGroup consecutive ones of the bound set. tile.glsl,
/// GroupSources.
struct SplatGroup {
    std::uint32_t first_surfel;
    std::uint32_t count;  // with kGroupShows
};
inline constexpr std::uint32_t kGroupShows = 1u << 31;  // setup need not look for those that cannot be seen
static_assert(sizeof(SplatGroup) == 8);

/// Groups of one chunk of a model, set up by one dispatch: their number, their first in the batch, and in the plan.
struct SplatJob {
    const InstanceDraws* instance;
    VkDescriptorSet surfels;
    std::uint32_t groups, first_group, first_source;
    Technique technique;
};

struct GroupRange {
    std::uint32_t first = 0, count = 0;
};

/// Groups of a technique are consecutive; those of tiles come first.
struct SplatBatch {
    std::vector<SplatJob> jobs;
    std::array<GroupRange, kTechniques> ranges{};
    std::uint64_t groups = 0;
    const GroupRange& range(Technique technique) const { return ranges[static_cast<std::size_t>(technique)]; }
};

/// Surfels that the host kept from setup, and from the part of setup that looks for what cannot be seen.
struct SetupCounts {
    std::uint64_t groups = 0, surfels = 0;  // sent to setup
    std::uint64_t culled_surfels = 0;       // not sent
    std::uint64_t certain_groups = 0;       // with kGroupShows
    friend bool operator==(const SetupCounts&, const SetupCounts&) = default;
};

struct SplatPlan {
    std::vector<SplatBatch> batches;  // at least one
    std::vector<SplatGroup> groups;   // of all batches
    SetupCounts counts;
};

/// Batches of at most `most_groups` groups each, without what SurfelBounds tell not to be seen in such a frame: the
/// picture is the same. `draws` must outlive the result.
SplatPlan plan_splats(const DrawList& draws, const Techniques& techniques, std::uint64_t most_groups,
                      const FrameSettings& settings);

}  // namespace splice
