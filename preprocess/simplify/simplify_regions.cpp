// A level of the octree at a time from below. Grouping what was simplified apart and simplifying it together is how
// Yoon et al. 2004 (Quick-VDR) and Cignoni et al. 2004 (Adaptive TetraPuzzles) come to large meshes' levels.
#include "preprocess/simplify/simplify_regions.h"

#include "preprocess/simplify/region_simplifier.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace splice {
namespace {

// Nodes with fewer triangles in the finest level leave it to their parents: most of theirs are at their border.
constexpr std::uint64_t kLeastTriangles = 1024;

// Of the triangles that a node gets. An octree's node has about four times as many as a child, so it goes on to a
// quarter; the root goes on as long as that gets somewhere.
constexpr std::array kShares{0.6, 0.36, 0.22};
constexpr double kGetsSomewhere = 0.9;
constexpr std::uint64_t kFewest = 64;  // triangles

constexpr std::uint32_t kNone = 0xffffffffu;

class Simplifier {
  public:
    Simplifier(const IndexedMesh& mesh, const RenderVertices& vertices, const PatchSet& patches,
               std::span<const std::uint32_t> order, std::span<const format::OctreeNode> octree)
        : mesh_(mesh),
          vertices_(vertices),
          patches_(patches),
          order_(order),
          octree_(octree),
          left_(octree.size()),
          levels_(octree.size()) {}

    RegionLods simplify(const Progress& progress) {
        // Nodes are breadth first, so those of a depth are contiguous.
        std::vector<std::uint32_t> depth_begin{0, 1};
        while (depth_begin.back() < octree_.size()) {
            std::uint32_t end = depth_begin.back();
            for (std::uint32_t i = depth_begin.end()[-2]; i < depth_begin.back(); ++i)
                end += octree_[i].child_count;
            depth_begin.push_back(end);
        }
        for (std::size_t depth = depth_begin.size() - 1; depth-- > 0;) {
            simplify_depth(depth_begin[depth], depth_begin[depth + 1]);
            if (progress)
                progress("levels", 1 - static_cast<double>(depth) / static_cast<double>(depth_begin.size() - 1));
        }
        RegionLods result;
        result.level_begin.push_back(0);
        for (const std::vector<RegionLevel>& node : levels_) {
            for (const RegionLevel& level : node) {
                result.levels.push_back({result.indices.size(),
                                         static_cast<std::uint32_t>(level.triangles.corners.size()),
                                         static_cast<float>(std::max(level.shape_error, level.looks_error))});
                append(level.triangles, static_cast<std::uint32_t>(result.vertices.size()), result.indices);
                result.vertices.insert(result.vertices.end(), level.triangles.vertices.begin(),
                                       level.triangles.vertices.end());
            }
            result.level_begin.push_back(static_cast<std::uint32_t>(result.levels.size()));
        }
        return result;
    }

  private:
    // What of a node's triangles is left for its parent.
    struct Left {
        RegionTriangles triangles;
        double shape_error = 0, looks_error = 0;  // RegionLevel
    };

    void simplify_depth(std::uint32_t begin, std::uint32_t end) {
        tbb::parallel_for(begin, end, [&](std::uint32_t node) { collect(node); });
        const std::vector<std::uint8_t> shared = find_shared(begin, end);
        tbb::enumerable_thread_specific<RegionSimplifier> simplifiers(
            [&] { return RegionSimplifier(mesh_, vertices_, shared); });
        tbb::parallel_for(begin, end, [&](std::uint32_t index) {
            if (!has_levels(index)) return;
            simplify_node(index, simplifiers.local());
            while (index == 0 && left_[0].triangles.corners.size() > 3 * kFewest &&
                   simplify_node(index, simplifiers.local())) {
            }
        });
    }

    // False if it did not get far.
    bool simplify_node(std::uint32_t index, RegionSimplifier& simplifier) {
        Left& left = left_[index];
        const auto before = static_cast<double>(left.triangles.corners.size());
        const double below = left.shape_error;
        std::vector<RegionLevel> coarser = simplifier.simplify(left.triangles, kShares, index != 0);
        if (coarser.empty()) return false;
        for (RegionLevel& level : coarser) {
            // Distances of one step and another are independent: squares add up. What was filtered is filtered again.
            level.shape_error = left.shape_error = std::max(left.shape_error, std::hypot(level.shape_error, below));
            level.looks_error = left.looks_error = std::max(left.looks_error, level.looks_error);
        }
        left.triangles = coarser.back().triangles;
        const bool got_somewhere = static_cast<double>(left.triangles.corners.size()) < kGetsSomewhere * before;
        if (got_somewhere) std::ranges::move(coarser, std::back_inserter(levels_[index]));
        return got_somewhere;
    }

    void append(const RegionTriangles& triangles, std::uint32_t own, std::vector<std::uint32_t>& corners) const {
        for (const std::uint32_t corner : triangles.corners)
            corners.push_back(corner < first_own() ? corner : corner + own);
    }

    std::uint32_t first_own() const { return static_cast<std::uint32_t>(vertices_.vertices.size()); }

    std::span<const std::uint32_t> triangles_of(std::uint32_t place) const {
        const std::uint32_t patch = order_[place];
        return std::span(patches_.patch_triangles)
            .subspan(patches_.patch_begin[patch], patches_.patch_begin[patch + 1] - patches_.patch_begin[patch]);
    }

    void collect(std::uint32_t index) {
        const format::OctreeNode& node = octree_[index];
        Left& left = left_[index];
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child) {
            const Left from = std::exchange(left_[child], {});
            RegionTriangles& all = left.triangles;
            append(from.triangles, static_cast<std::uint32_t>(all.vertices.size()), all.corners);
            all.vertices.insert(all.vertices.end(), from.triangles.vertices.begin(), from.triangles.vertices.end());
            all.position.insert(all.position.end(), from.triangles.position.begin(), from.triangles.position.end());
            left.shape_error = std::max(left.shape_error, from.shape_error);
            left.looks_error = std::max(left.looks_error, from.looks_error);
        }
        for (std::uint32_t place = 0; node.child_count == 0 && place < node.patch_count; ++place) {
            for (const std::uint32_t triangle : triangles_of(node.first_patch + place))
                for (std::size_t k = 0; k < 3; ++k)
                    left.triangles.corners.push_back(vertices_.indices[std::size_t{3} * triangle + k]);
        }
    }

    bool has_levels(std::uint32_t index) const {
        const format::OctreeNode& node = octree_[index];
        const std::uint32_t material = patches_.patches[order_[node.first_patch]].material;
        std::uint64_t triangles = 0;
        for (std::uint32_t place = node.first_patch; place < node.first_patch + node.patch_count; ++place) {
            if (patches_.patches[order_[place]].material != material) return false;
            triangles += triangles_of(place).size();
        }
        return triangles >= kLeastTriangles || index == 0;
    }

    // Nonzero for positions where triangles of several nodes of a depth meet, or of nodes and patches above it.
    std::vector<std::uint8_t> find_shared(std::uint32_t begin, std::uint32_t end) const {
        std::vector<std::uint32_t> owner_of_place(order_.size());
        for (std::uint32_t place = 0; place < order_.size(); ++place)
            owner_of_place[place] = static_cast<std::uint32_t>(octree_.size()) + place;
        for (std::uint32_t index = begin; index < end; ++index)
            std::fill_n(owner_of_place.begin() + octree_[index].first_patch, octree_[index].patch_count, index);
        std::vector<std::uint32_t> owner(mesh_.positions.size(), kNone);
        std::vector<std::uint8_t> shared(mesh_.positions.size(), 0);
        for (std::uint32_t place = 0; place < order_.size(); ++place)
            for (const std::uint32_t triangle : triangles_of(place))
                for (const std::uint32_t position : mesh_.triangles[triangle]) {
                    if (owner[position] == kNone) owner[position] = owner_of_place[place];
                    if (owner[position] != owner_of_place[place]) shared[position] = 1;
                }
        return shared;
    }

    const IndexedMesh& mesh_;
    const RenderVertices& vertices_;
    const PatchSet& patches_;
    std::span<const std::uint32_t> order_;
    std::span<const format::OctreeNode> octree_;
    std::vector<Left> left_;
    std::vector<std::vector<RegionLevel>> levels_;
};

}  // namespace

RegionLods simplify_regions(const IndexedMesh& mesh, const RenderVertices& vertices, const PatchSet& patches,
                            std::span<const std::uint32_t> order, std::span<const format::OctreeNode> octree,
                            const Progress& progress) {
    return Simplifier(mesh, vertices, patches, order, octree).simplify(progress);
}

}  // namespace splice
