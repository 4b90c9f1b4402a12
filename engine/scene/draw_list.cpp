#include "engine/scene/draw_list.h"

#include "engine/scene/gpu_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace splice {

namespace {

// The error of a level of triangles is a root mean square: somewhere they are this many times as far off, about.
constexpr double kWorstOfError = 4;

enum class Containment { kOutside, kPartly, kInside };

template <typename T>
glm::dvec3 vector_of(const T (&v)[3]) {
    return {v[0], v[1], v[2]};
}

class Culler {
  public:
    Culler(const Camera& camera, std::uint32_t width, std::uint32_t height, const DrawListOptions& options,
           InstanceDraws& draws)
        : camera_(camera), options_(options), draws_(draws), scale_(pixel_scale(camera, height)) {
        half_x_ = 0.5 * width / scale_;
        half_y_ = 0.5 * height / scale_;
    }

    void visit_all() {
        const auto& octree = draws_.model->octree();
        if (cuts()) cut();
        if (octree.empty()) {
            visit_patches(0, static_cast<std::uint32_t>(draws_.model->patches().size()));
        } else {
            visit_node(0);
        }
    }

  private:
    struct Extent {
        Containment containment;
        double nearest;  // depth, view space
    };

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
            const Extent extent = locate(patch.bounds_min, patch.bounds_max);
            if (extent.containment == Containment::kOutside) continue;
            const format::Lod& level = level_of(patch, extent.nearest);
            if (level.index_count == 0) continue;  // a cloud's
            const DrawLoad load = load_of_triangles(patch, level, extent.nearest);
            costs[i] =
                (price.triangle * load.triangles + price.triangle_hit * load.triangle_hits +
                 price.triangle_pixel * load.triangle_pixels - price.splat_pixel * pixels_of(patch, extent.nearest)) /
                price.splat;
        }
        return costs;
    }

    // Of a surface that is turned every way, half of the patch's area as it is seen face on. A cloud's area is not
    // known: the mean silhouette of a box is a quarter of its surface.
    double pixels_of(const format::Patch& patch, double nearest) const {
        const double unit = scale_ * draws_.scale / (camera_.orthographic ? 1 : std::max(nearest, camera_.near_plane));
        const double all = 4 * half_x_ * half_y_ * scale_ * scale_;
        const glm::dvec3 size = vector_of(patch.bounds_max) - vector_of(patch.bounds_min);
        const double of_box = 0.5 * (size.x * size.y + size.y * size.z + size.z * size.x);
        const double seen = patch.area > 0.0F ? 0.5 * static_cast<double>(patch.area) : of_box;
        return std::min(seen * unit * unit, all);
    }

    DrawLoad load_of_triangles(const format::Patch& patch, const format::Lod& level, double nearest) const {
        // Patches that face away are not left out: half of what is drawn of a closed surface is culled by the device.
        const double seen = draws_.two_sided ? 1 : 0.5;
        const double triangles = level.index_count / 3, pixels = seen * pixels_of(patch, nearest);
        return {.triangles = triangles, .triangle_hits = std::min(seen * triangles, pixels), .triangle_pixels = pixels};
    }

    CutView cut_view(std::span<const double> costs) const {
        return {.model_to_view = draws_.model_to_view,
                .scale = draws_.scale,
                .orthographic = camera_.orthographic,
                .pixel_scale = scale_,
                .half_x = half_x_,
                .half_y = half_y_,
                .near_plane = camera_.near_plane,
                .two_sided = draws_.two_sided,
                .tau = options_.tau,
                .max_point_size = options_.force_quads ? 0 : options_.max_point_size,
                .triangle_costs = costs};
    }

    // The coarsest triangles whose error is within tau wherever in the patch it is.
    const format::Lod& level_of(const format::Patch& patch, double nearest) const {
        const format::Lod* level = &draws_.model->lods()[patch.first_lod];
        if (options_.tau == 0 || (!camera_.orthographic && nearest <= camera_.near_plane)) return *level;
        const double stretch = camera_.orthographic ? 1 : std::hypot(1.0, half_x_, half_y_) / nearest;
        const double pixels = scale_ * draws_.scale * stretch;
        for (std::uint32_t next = 1; next < patch.lod_count; ++next) {
            const format::Lod& coarser = draws_.model->lods()[patch.first_lod + next];
            if (kWorstOfError * static_cast<double>(coarser.error) * pixels > options_.tau) break;
            level = &coarser;
        }
        return *level;
    }

    // A box of unit-box space against the frustum. The prefilter lets splats reach beyond their disks, and so beyond
    // the box: what misses the picture by no more than that is kept.
    Extent locate(const float (&low)[3], const float (&high)[3]) const {
        const double margin = kPrefilterReach / scale_;
        std::array<int, 5> outside{};
        std::array<int, 5> inside{};
        double nearest = std::numeric_limits<double>::max();
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 p =
                draws_.model_to_view * glm::dvec4((corner & 1) ? high[0] : low[0], (corner & 2) ? high[1] : low[1],
                                                  (corner & 4) ? high[2] : low[2], 1);
            const double depth = -p.z;
            const double reach = camera_.orthographic ? 1 : depth;
            const std::array<double, 5> beyond{p.x - half_x_ * reach, -p.x - half_x_ * reach, p.y - half_y_ * reach,
                                               -p.y - half_y_ * reach, camera_.near_plane - depth};
            const double slack = margin * std::max(reach, 0.0);
            for (std::size_t plane = 0; plane < beyond.size(); ++plane) {
                outside[plane] += beyond[plane] > (plane < 4 ? slack : 0) ? 1 : 0;
                inside[plane] += beyond[plane] < 0 ? 1 : 0;
            }
            nearest = std::min(nearest, depth);
        }
        const auto all = [](int corners) { return corners == 8; };
        if (std::any_of(outside.begin(), outside.end(), all)) return {Containment::kOutside, nearest};
        return {std::all_of(inside.begin(), inside.end(), all) ? Containment::kInside : Containment::kPartly, nearest};
    }

    // True if every normal in the patch's cone is beyond the horizon from the eye, wherever in the patch it sits
    // (Pajarola et al. 2004, section 6.2, with the extent of the patch taken into account: beta + theta + alpha < 90
    // degrees, here less what shaders draw beyond the horizon).
    bool faces_away(const format::Patch& patch) const {
        if (patch.cone_cos <= 0) return false;
        const glm::dvec3 axis = glm::normalize(glm::dmat3(draws_.model_to_view) * vector_of(patch.cone_axis));
        const double spread = std::acos(std::min(static_cast<double>(patch.cone_cos), 1.0));
        glm::dvec3 away(0, 0, -1);
        double alpha = 0;
        if (!camera_.orthographic) {
            const glm::dvec3 low = vector_of(patch.bounds_min), high = vector_of(patch.bounds_max);
            const glm::dvec3 centre(draws_.model_to_view * glm::dvec4((low + high) * 0.5, 1));
            const double radius = 0.5 * glm::length(high - low) * draws_.scale;
            const double distance = glm::length(centre);
            if (distance <= radius) return false;
            away = centre / distance;
            alpha = std::asin(radius / distance);
        }
        const double beta = std::acos(std::clamp(glm::dot(axis, away), -1.0, 1.0));
        constexpr double kRounding = 1e-3;  // radians; normals are quantised
        return beta + spread + alpha + kRounding < std::acos(-kHorizon);
    }

    void visit_node(std::uint32_t index) {
        const auto& octree = draws_.model->octree();
        const format::OctreeNode& node = octree[index];
        const Extent extent = locate(node.bounds_min, node.bounds_max);
        if (extent.containment == Containment::kOutside) return;
        std::uint32_t next = node.first_patch;
        const std::uint32_t end = node.first_patch + node.patch_count;
        if (extent.containment == Containment::kPartly) {
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
            visit_patch(patch);
    }

    void visit_patch(std::uint32_t index) {
        const format::Patch& patch = draws_.model->patches()[index];
        const bool triangles = options_.surfels_as_triangles ||
                               patch.representation == format::Representation::kTriangles ||
                               (!by_triangles_.empty() && by_triangles_[index]);
        if (!(triangles ? options_.draw_triangles : options_.draw_surfels)) return;
        const Extent extent = locate(patch.bounds_min, patch.bounds_max);
        if (extent.containment == Containment::kOutside) return;
        if (triangles) {
            const format::Lod& level = level_of(patch, extent.nearest);
            draws_.load += load_of_triangles(patch, level, extent.nearest);
            append(draws_.triangles, {level.first_index, level.index_count, patch.material, index},
                   options_.merge_patches);
            return;
        }
        if (patch.surfel_count == 0 || (!draws_.two_sided && faces_away(patch))) return;
        draws_.load.splat_pixels += pixels_of(patch, extent.nearest);
        if (cuts()) return;
        draws_.load.splats += static_cast<double>(patch.surfel_count);
        const double largest = largest_splat(patch, extent.nearest);
        const bool sprite =
            !options_.force_quads && extent.containment == Containment::kInside && largest <= options_.max_point_size;
        auto& ranges = largest <= options_.small_px ? draws_.small : sprite ? draws_.sprites : draws_.quads;
        append(ranges, {patch.first_surfel, patch.surfel_count, 0, index}, true);
    }

    // Upper bound of the size in pixels of the point that encloses any splat of a patch inside the frustum: for |a|,
    // |b| <= r, (x + a) / (d + b) - x / d is at most r (1 + |x / d|) / (d - r). `nearest` is a depth of the bounds,
    // which hold the disks.
    double largest_splat(const format::Patch& patch, double nearest) const {
        if (nearest <= camera_.near_plane) return std::numeric_limits<double>::infinity();
        const double radius = kSolidReach * patch.max_surfel_radius * draws_.scale;
        const double stretch = camera_.orthographic ? 1 : (1 + std::max(half_x_, half_y_)) / nearest;
        return 2 * (scale_ * radius * stretch + kPrefilterReach);
    }

    static void append(std::vector<DrawRange>& ranges, const DrawRange& range, bool merge) {
        if (range.count == 0) return;
        if (merge && !ranges.empty()) {
            DrawRange& last = ranges.back();
            const bool fits = last.count <= std::numeric_limits<std::uint32_t>::max() - range.count;
            if (last.material == range.material && last.first + last.count == range.first && fits) {
                last.count += range.count;
                return;
            }
        }
        ranges.push_back(range);
    }

    const Camera& camera_;
    const DrawListOptions& options_;
    InstanceDraws& draws_;
    double scale_;                    // pixels per unit at depth 1, or anywhere
    double half_x_, half_y_;          // of the picture, at depth 1 or anywhere
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
        list.surfels += draws.cut.statistics.ellipses + draws.cut.statistics.surfels;
    }
    list.load.frame_pixels = static_cast<double>(width) * height;
    list.predicted_ms = predicted_ms(options.costs, list.load);
    return list;
}

}  // namespace splice
