#include "engine/scene/draw_list.h"

#include "engine/scene/gpu_model.h"
#include "engine/scene/patch_groups.h"
#include "engine/scene/patch_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splice {

namespace {

class Culler {
  public:
    Culler(const Camera& camera, std::uint32_t width, std::uint32_t height, const DrawListOptions& options,
           InstanceDraws& draws)
        : camera_(camera),
          options_(options),
          draws_(draws),
          seen_(camera, width, height, draws.model_to_view, draws.scale),
          triangle_sight_(camera, width, height, draws.model_to_view, draws.scale, draws.two_sided, kTriangleHorizon) {}

    void visit_all() {
        drawn_.assign(draws_.model->patches().size(), false);
        if (groups()) choose_groups();
        if (groups_.chosen.empty() || !groups_.chosen.front())
            visit_rest();
        else
            draws_.patches.in_groups = drawn_.size();
        draws_.cut.statistics.groups_by_triangles = groups_.groups.size();
        if (options_.boxes_px == 0) return;
        draws_.boxes = node_boxes({.octree = draws_.model->octree(),
                                   .hierarchy = draws_.model->hierarchy(),
                                   .groups = groups_.chosen,
                                   .patches = drawn_,
                                   .cut = draws_.cut},
                                  seen_, options_.boxes_px);
    }

  private:
    using Extent = PatchView::Extent;

    // What no group stands for.
    void visit_rest() {
        const auto& octree = draws_.model->octree();
        if (cuts()) cut();
        if (octree.empty()) {
            visit_patches(0, static_cast<std::uint32_t>(draws_.model->patches().size()));
        } else {
            visit_node(0);
        }
    }

    // Whether triangles of several patches together may take the place of both triangles and surfels.
    bool groups() const {
        return options_.tau > 0 && options_.draw_triangles && options_.merge_patches &&
               (options_.draw_surfels || options_.surfels_as_triangles);
    }

    void choose_groups() {
        groups_ = choose_patch_groups(*draws_.model, seen_,
                                      {.tau = options_.tau,
                                       .costs = options_.costs,
                                       .two_sided = draws_.two_sided,
                                       .triangles_only = options_.surfels_as_triangles});
        for (const PatchGroup& group : groups_.groups)
            add_group(group);
        draws_.load += groups_.load;
    }

    // The runs of a group's triangles of which some may be seen.
    void add_group(const PatchGroup& group) {
        const format::Lod& level = draws_.model->lods()[group.level];
        constexpr std::uint32_t kIndices = 3 * kBoundedTriangles;
        std::uint32_t first = 0;
        for (const SurfelBounds& run : draws_.model->triangle_bounds().of(group.level)) {
            if (!options_.cull_groups || triangle_sight_.of(run) != Sight::kNone)
                append(draws_.triangles,
                       {level.first_index + first, std::min(kIndices, level.index_count - first), group.material,
                        label(group.first_patch, group.number, group.depth)},
                       true);
            first += kIndices;
        }
    }

    // Whether surfels come from the point tree; if not, from the patches.
    bool cuts() const {
        return (options_.tau > 0 || draws_.model->pager() != nullptr) && options_.draw_surfels &&
               !options_.surfels_as_triangles && !draws_.model->hierarchy().empty();
    }

    void cut() {
        const std::vector<double> costs = triangle_costs();
        draws_.cut = cut_points(draws_.model->hierarchy(), cut_view(costs));
        draws_.load.splats = static_cast<double>(draws_.cut.statistics.ellipses + draws_.cut.statistics.surfels);
        by_triangles_.assign(draws_.model->patches().size(), false);
        for (const std::uint32_t patch : draws_.cut.triangle_patches)
            by_triangles_[patch] = true;
    }

    // Of each surfel patch, CutView::triangle_costs.
    std::vector<double> triangle_costs() const {
        std::vector<double> costs;
        if (!options_.draw_triangles) return costs;
        const DrawCosts& price = options_.costs;
        costs.resize(draws_.model->patches().size(), std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < costs.size(); ++i) {
            const format::Patch& patch = draws_.model->patches()[i];
            if (patch.surfel_count == 0) continue;
            const Extent extent = seen_.locate(patch.bounds_min, patch.bounds_max);
            if (extent.containment == Containment::kOutside) continue;
            const format::Lod& level = draws_.model->lods()[patch.first_lod + level_number(patch, extent)];
            if (level.index_count == 0) continue;  // a cloud's
            const double pixels = pixels_of(patch, extent.nearest);
            const DrawLoad load = PatchView::load_of_triangles(level, pixels, draws_.two_sided);
            costs[i] = (price.triangle * load.triangles + price.triangle_hit * load.triangle_hits +
                        price.triangle_pixel * load.triangle_pixels - price.splat_pixel * pixels) /
                       price.splat;
        }
        return costs;
    }

    double pixels_of(const format::Patch& patch, double nearest) const {
        return seen_.pixels_of(static_cast<double>(patch.area), patch.bounds_min, patch.bounds_max, nearest);
    }

    CutView cut_view(std::span<const double> costs) const {
        return {.model_to_view = draws_.model_to_view,
                .scale = draws_.scale,
                .orthographic = camera_.orthographic,
                .pixel_scale = seen_.pixel_scale(),
                .half_x = seen_.half_x(),
                .half_y = seen_.half_y(),
                .near_plane = camera_.near_plane,
                .two_sided = draws_.two_sided,
                .tau = options_.tau,
                .max_point_size = options_.force_quads ? 0 : options_.max_point_size,
                .triangle_costs = costs,
                .left_out = groups_.surfels};
    }

    // The coarsest triangles whose error is within tau.
    std::size_t level_number(const format::Patch& patch, const Extent& extent) const {
        const auto levels = std::span(draws_.model->lods()).subspan(patch.first_lod, patch.lod_count);
        return seen_.levels_within(levels.subspan(1), options_.tau, extent);
    }

    std::uint32_t label(std::uint32_t patch, std::size_t number, std::uint32_t depth) const {
        return options_.label_levels ? level_label(static_cast<std::uint32_t>(number), depth) : patch;
    }

    void visit_node(std::uint32_t index) {
        const auto& octree = draws_.model->octree();
        const format::OctreeNode& node = octree[index];
        if (!groups_.chosen.empty() && groups_.chosen[index]) {
            draws_.patches.in_groups += node.patch_count;
            return;
        }
        const Extent extent = seen_.locate(node.bounds_min, node.bounds_max);
        if (extent.containment == Containment::kOutside) {
            draws_.patches.outside_frustum += node.patch_count;
            return;
        }
        std::uint32_t next = node.first_patch;
        const std::uint32_t end = node.first_patch + node.patch_count;
        if (extent.containment == Containment::kPartly || !groups_.groups.empty()) {
            for (std::uint32_t child = 0; child < node.child_count; ++child) {
                const format::OctreeNode& below = octree[node.first_child + child];
                visit_patches(next, below.first_patch);
                visit_node(node.first_child + child);
                next = below.first_patch + below.patch_count;
            }
        }
        visit_patches(next, end);
    }

    void visit_patches(std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t patch = first; patch < end; ++patch)
            ++(draws_.patches.*visit_patch(patch));
    }

    // Returns what became of it.
    std::uint64_t PatchCounts::*visit_patch(std::uint32_t index) {
        const format::Patch& patch = draws_.model->patches()[index];
        const bool triangles = options_.surfels_as_triangles ||
                               patch.representation == format::Representation::kTriangles ||
                               (!by_triangles_.empty() && by_triangles_[index]);
        if (!(triangles ? options_.draw_triangles : options_.draw_surfels)) return &PatchCounts::unwanted;
        const Extent extent = seen_.locate(patch.bounds_min, patch.bounds_max);
        if (extent.containment == Containment::kOutside) return &PatchCounts::outside_frustum;
        if (!draws_.two_sided && seen_.faces_away(patch.cone_axis, patch.cone_cos, patch.bounds_min, patch.bounds_max))
            return &PatchCounts::facing_away;
        if (triangles) {
            const std::size_t number = level_number(patch, extent);
            const format::Lod& level = draws_.model->lods()[patch.first_lod + number];
            draws_.load += PatchView::load_of_triangles(level, pixels_of(patch, extent.nearest), draws_.two_sided);
            append(draws_.triangles, {level.first_index, level.index_count, patch.material, label(index, number, 0)},
                   options_.merge_patches);
            drawn_[index] = true;
            return &PatchCounts::drawn;
        }
        if (patch.surfel_count == 0) return &PatchCounts::unwanted;
        draws_.load.splat_pixels += pixels_of(patch, extent.nearest);
        if (cuts()) return &PatchCounts::in_cut;
        drawn_[index] = true;
        const MergedRange drawn = surfels_of(index, extent);
        draws_.load.splats += static_cast<double>(drawn.count);
        const double largest = largest_splat(patch.max_surfel_radius + drawn.growth, extent.nearest);
        const bool sprite =
            !options_.force_quads && extent.containment == Containment::kInside && largest <= options_.max_point_size;
        auto& ranges = largest <= options_.small_px ? draws_.small : sprite ? draws_.sprites : draws_.quads;
        append(ranges, {drawn.first, drawn.count, 0, index}, true);
        return &PatchCounts::drawn;
    }

    // The surfels of a patch, or what may stand for them from here.
    MergedRange surfels_of(std::uint32_t index, const Extent& extent) {
        const format::Patch& patch = draws_.model->patches()[index];
        MergedRange drawn{patch.first_surfel, patch.surfel_count, 0};
        for (const std::vector<MergedRange>& level : draws_.model->merged_levels()) {
            const MergedRange& range = level[index];
            if (range.count == 0) continue;
            if (!seen_.within(static_cast<double>(range.growth), options_.merge_px, extent)) break;
            drawn = range;
        }
        if (drawn.first == patch.first_surfel) return drawn;
        draws_.merged += {drawn.count, patch.surfel_count};
        return drawn;
    }

    // Upper bound of the size in pixels of the point that encloses any splat of a patch inside the frustum: for |a|,
    // |b| <= r, (x + a) / (d + b) - x / d is at most r (1 + |x / d|) / (d - r). `nearest` is a depth of the bounds,
    // which hold the disks.
    double largest_splat(float largest_radius, double nearest) const {
        if (nearest <= camera_.near_plane) return std::numeric_limits<double>::infinity();
        const double radius = kSolidReach * static_cast<double>(largest_radius) * draws_.scale;
        const double stretch = camera_.orthographic ? 1 : (1 + std::max(seen_.half_x(), seen_.half_y())) / nearest;
        return 2 * (seen_.pixel_scale() * radius * stretch + kPrefilterReach);
    }

    void append(std::vector<DrawRange>& ranges, const DrawRange& range, bool merge) const {
        if (range.count == 0) return;
        if (merge && !ranges.empty()) {
            DrawRange& last = ranges.back();
            const bool fits = last.count <= std::numeric_limits<std::uint32_t>::max() - range.count;
            const bool alike = last.material == range.material && (!options_.label_levels || last.patch == range.patch);
            if (alike && last.first + last.count == range.first && fits) {
                last.count += range.count;
                return;
            }
        }
        ranges.push_back(range);
    }

    const Camera& camera_;
    const DrawListOptions& options_;
    InstanceDraws& draws_;
    PatchView seen_;
    SurfelSight triangle_sight_;
    PatchGroups groups_;
    std::vector<bool> drawn_;         // patches, one by one
    std::vector<bool> by_triangles_;  // surfel patches, where the cut chose
};

glm::dmat4 model_to_world(const Instance& instance) {
    const format::ModelInfo& info = instance.model->info();
    const Transform& transform = instance.transform;
    glm::dmat4 to_world(transform.rotation * (transform.scale * info.source_scale));
    to_world[3] =
        glm::dvec4(transform.rotation * (vector_of(info.source_offset) * transform.scale) + transform.translation, 1);
    return to_world;
}

}  // namespace

void look_from(DrawList& draws, const Scene& scene, const Camera& camera) {
    const glm::dmat4 view = view_matrix(camera);
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        draws.instances[i].model_to_view = view * model_to_world(scene.instances[i]);
}

DrawList build_draw_list(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                         const DrawListOptions& options) {
    DrawList list;
    list.instances.resize(scene.instances.size());
    const glm::dmat4 view = view_matrix(camera);
    std::uint32_t first_patch = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        InstanceDraws& draws = list.instances[i];
        draws.model = instance.model.get();
        draws.surfels = &instance.model->surfels();
        draws.indices = &instance.model->indices();
        draws.scale = instance.transform.scale * instance.model->info().source_scale;
        draws.model_to_view = view * model_to_world(instance);
        draws.two_sided =
            options.sides == Sides::kAsBaked ? instance.model->two_sided() : options.sides == Sides::kTwoSided;
        draws.first_patch = first_patch;
        first_patch += static_cast<std::uint32_t>(scene.instances[i].model->patches().size());
    }
    tbb::parallel_for(std::size_t{0}, list.instances.size(),
                      [&](std::size_t i) { Culler(camera, width, height, options, list.instances[i]).visit_all(); });
    for (const InstanceDraws& draws : list.instances) {
        for (const DrawRange& range : draws.triangles)
            list.triangles += range.count / 3;
        for (const auto* ranges : {&draws.sprites, &draws.quads, &draws.small})
            for (const DrawRange& range : *ranges)
                list.surfels += range.count;
        list.cut += draws.cut.statistics;
        list.load += draws.load;
        list.merged += draws.merged;
        list.patches += draws.patches;
        list.surfels += draws.cut.statistics.ellipses + draws.cut.statistics.surfels;
    }
    list.load.frame_pixels = static_cast<double>(width) * height;
    list.predicted_ms = predicted_ms(options.costs, list.load);
    return list;
}

}  // namespace splice
