// What of a scene is sent to the device for one view: patches culled on the CPU (frustum, and normal cones where
// back-facing surfaces are invisible), the rest merged into few draws and sorted by the primitive that draws them
// right.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/draw_costs.h"
#include "engine/scene/lod_cut.h"
#include "engine/scene/named.h"
#include "engine/scene/node_boxes.h"
#include "engine/scene/scene.h"
#include "engine/scene/splat_reach.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace splice {

class SurfelStore;
namespace gpu {
class Buffer;
}

/// Consecutive indices or surfels of one model.
struct DrawRange {
    std::uint64_t first = 0;  // into the model's index or surfel buffer
    std::uint32_t count = 0;
    std::uint32_t material = 0;  // triangles
    std::uint32_t patch = 0;     // the first patch of the range; see DrawListOptions::label_levels
};

/// What stands for a patch number in shaders that colour triangles by their level: how coarse, 0 the finest, and the
/// depth in the octree, counted from 1, of the node whose patches they are of; 0: of a patch alone.
/// shaders/glsl/include/colour.glsl takes it apart.
constexpr std::uint32_t level_label(std::uint32_t number, std::uint32_t depth) {
    return number << 8 | depth;
}

/// Splats that are drawn in place of surfels (merged_surfels.h), and those surfels.
struct MergedCounts {
    std::uint64_t splats = 0, surfels = 0;
    MergedCounts& operator+=(const MergedCounts& other) {
        splats += other.splats;
        surfels += other.surfels;
        return *this;
    }
};

/// What became of patches, each counted once.
struct PatchCounts {
    std::uint64_t drawn = 0;      // one by one
    std::uint64_t in_groups = 0;  // with others, by triangles of a node of the octree
    std::uint64_t in_cut = 0;     // left to the cut through the point tree
    std::uint64_t outside_frustum = 0, facing_away = 0;
    std::uint64_t unwanted = 0;  // of a kind that is not to be drawn, or without surfels
    PatchCounts& operator+=(const PatchCounts& other) {
        drawn += other.drawn;
        in_groups += other.in_groups;
        in_cut += other.in_cut;
        outside_frustum += other.outside_frustum;
        facing_away += other.facing_away;
        unwanted += other.unwanted;
        return *this;
    }
    friend bool operator==(const PatchCounts&, const PatchCounts&) = default;
};

struct InstanceDraws {
    const GpuModel* model = nullptr;
    const SurfelStore* surfels = nullptr;  // what `sprites` and `quads` are ranges of
    const gpu::Buffer* indices = nullptr;  // what `triangles` are ranges of
    glm::dmat4 model_to_view{1.0};         // from unit-box units
    double scale = 1;                      // world units per unit-box unit
    bool two_sided = false;
    std::uint32_t first_patch = 0;  // patches of the instances before
    std::vector<DrawRange> triangles;
    std::vector<DrawRange> sprites;  // surfels that fit a point: small, and wholly inside the frustum
    std::vector<DrawRange> quads;    // the others
    std::vector<DrawRange> small;    // instead of either: those of DrawListOptions::small_px
    std::vector<NodeBox> boxes;      // with DrawListOptions::boxes_px: of what is drawn
    LodCut cut;                      // with DrawListOptions::tau: surfels and ellipses; CutStore makes ranges of it
    DrawLoad load = {};
    MergedCounts merged;
    PatchCounts patches;
};

struct DrawList {
    std::vector<InstanceDraws> instances;
    std::uint64_t triangles = 0, surfels = 0;  // ellipses are surfels, too
    CutStatistics cut;                         // of all instances
    DrawLoad load = {};
    MergedCounts merged;
    PatchCounts patches;
    double predicted_ms = 0;  // what DrawListOptions::costs make of it
};

enum class Sides { kAsBaked, kOneSided, kTwoSided };

inline constexpr Names<Sides, 3> kSidesNames{
    {{Sides::kAsBaked, "as-baked"}, {Sides::kOneSided, "one-sided"}, {Sides::kTwoSided, "two-sided"}}};

constexpr std::string_view name_of(Sides sides) {
    return name_in(kSidesNames, sides);
}

struct DrawListOptions {
    Sides sides = Sides::kAsBaked;
    bool draw_triangles = true, draw_surfels = true;
    bool surfels_as_triangles = false;  // surfel patches by their triangles
    bool label_levels = false;          // ranges of triangles have level_label() in place of a patch
    bool merge_patches = true;          // false: one draw a triangle patch, so that shaders can tell them apart
    bool force_quads = false;
    bool cull_groups = true;           // see CaptureSettings; of triangles of several patches together
    double max_point_size = 255;       // pixels, of the device
    double small_px = 0;               // patches whose splats are all at most this wide go to InstanceDraws::small
    double boxes_px = 0;               // pixels: fill InstanceDraws::boxes, see node_boxes(); 0: none
    double merge_px = 0;               // pixels by which merged surfels may differ (MergedRange::growth); 0: none are
    double tau = 0;                    // pixels, of the cut (lod_cut.h); 0: full detail
    DrawCosts costs = kSoftwareCosts;  // with tau, surfel patches are drawn by their triangles where those cost less
};

/// Moves the eye and keeps what is drawn.
void look_from(DrawList& draws, const Scene& scene, const Camera& camera);

DrawList build_draw_list(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                         const DrawListOptions& options);

}  // namespace splice
