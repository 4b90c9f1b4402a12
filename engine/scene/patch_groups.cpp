#include "engine/scene/patch_groups.h"

#include "engine/scene/gpu_model.h"

#include <algorithm>

namespace splice {

namespace {

// Of a cut through the point tree at tau 1, over a pixel of half of the surface: as measured on scans.
constexpr double kSplatsPerPixel = 20;

class Chooser {
  public:
    Chooser(const GpuModel& model, const PatchView& seen, const PatchGroupOptions& options)
        : model_(model), seen_(seen), options_(options) {}

    PatchGroups choose() {
        if (model_.octree().empty()) return {};
        groups_.chosen.assign(model_.octree().size(), false);
        visit(0, 1);
        return std::move(groups_);
    }

  private:
    void visit(std::uint32_t index, std::uint32_t depth) {
        const format::OctreeNode& node = model_.octree()[index];
        if (!model_.group_contents()[index].has_levels) return;
        const PatchView::Extent extent = seen_.locate(node.bounds_min, node.bounds_max);
        if (extent.containment == Containment::kOutside) return;
        if (decide(index, depth, extent)) return;
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child)
            visit(child, depth + 1);
    }

    // Whether nothing is left to choose below the node.
    bool decide(std::uint32_t index, std::uint32_t depth, const PatchView::Extent& extent) {
        const format::OctreeNode& node = model_.octree()[index];
        const auto levels = std::span(model_.lods()).subspan(node.first_lod, node.lod_count);
        const std::size_t within = seen_.levels_within(levels, options_.tau, extent);
        if (within == 0) return false;
        const format::Lod& level = levels[within - 1];
        const PatchGroupContent& content = model_.group_contents()[index];
        const auto pixels_of = [&](double area) {
            return area > 0 ? seen_.pixels_of(area, node.bounds_min, node.bounds_max, extent.nearest) : 0;
        };
        const DrawLoad load = PatchView::load_of_triangles(
            level, pixels_of(content.triangle_area + content.surfel_area), options_.two_sided);
        // Below are only finer levels.
        if (!options_.triangles_only && cost(load) > cost(otherwise(content, pixels_of)))
            return within == levels.size();
        groups_.load += load;
        groups_.chosen[index] = true;
        groups_.groups.push_back({.level = node.first_lod + static_cast<std::uint32_t>(within - 1),
                                  .material = model_.patches()[node.first_patch].material,
                                  .first_patch = node.first_patch,
                                  .depth = depth,
                                  .number = static_cast<std::uint32_t>(within - 1)});
        if (content.surfels != 0)
            groups_.surfels.emplace_back(static_cast<std::uint32_t>(content.first_surfel),
                                         static_cast<std::uint32_t>(content.first_surfel + content.surfels));
        return true;
    }

    // What would be drawn in a group's place: finest triangles and a cut.
    template <typename PixelsOf>
    DrawLoad otherwise(const PatchGroupContent& content, const PixelsOf& pixels_of) const {
        const double seen = options_.two_sided ? 1 : 0.5;
        const double triangle_pixels = seen * pixels_of(content.triangle_area),
                     splat_pixels = pixels_of(content.surfel_area);
        return {.triangles = content.triangles,
                .triangle_hits = std::min(seen * content.triangles, triangle_pixels),
                .triangle_pixels = triangle_pixels,
                .splats = std::min(seen * static_cast<double>(content.surfels),
                                   kSplatsPerPixel * splat_pixels / (options_.tau * options_.tau)),
                .splat_pixels = splat_pixels};
    }

    double cost(const DrawLoad& load) const {
        DrawCosts costs = options_.costs;
        costs.frame = 0;
        return predicted_ms(costs, load);
    }

    const GpuModel& model_;
    const PatchView& seen_;
    const PatchGroupOptions& options_;
    PatchGroups groups_;
};

}  // namespace

std::vector<PatchGroupContent> patch_group_contents(std::span<const format::OctreeNode> octree,
                                                    std::span<const format::Patch> patches,
                                                    std::span<const format::Lod> lods) {
    std::vector<PatchGroupContent> contents(octree.size());
    for (std::size_t i = octree.size(); i-- > 0;) {
        const format::OctreeNode& node = octree[i];
        PatchGroupContent& content = contents[i];
        content.first_surfel = patches[node.first_patch].first_surfel;
        content.has_levels = node.lod_count != 0;
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child) {
            content.has_levels = content.has_levels || contents[child].has_levels;
            content.surfels += contents[child].surfels;
            content.triangles += contents[child].triangles;
            content.triangle_area += contents[child].triangle_area;
            content.surfel_area += contents[child].surfel_area;
        }
        for (std::uint32_t place = 0; node.child_count == 0 && place < node.patch_count; ++place) {
            const format::Patch& patch = patches[node.first_patch + place];
            content.surfels += patch.surfel_count;
            if (patch.representation == format::Representation::kTriangles) {
                content.triangles += lods[patch.first_lod].index_count / 3;
                content.triangle_area += static_cast<double>(patch.area);
            } else {
                content.surfel_area += static_cast<double>(patch.area);
            }
        }
    }
    return contents;
}

PatchGroups choose_patch_groups(const GpuModel& model, const PatchView& seen, const PatchGroupOptions& options) {
    return Chooser(model, seen, options).choose();
}

}  // namespace splice
