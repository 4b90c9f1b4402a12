// A level of the octree at a time from below. Grouping what was simplified apart and simplifying it together is how
// Yoon et al. 2004 (Quick-VDR) and Cignoni et al. 2004 (Adaptive TetraPuzzles) come to large meshes' levels.
#include "preprocess/simplify/simplify_regions.h"

#include "preprocess/simplify/cluster_triangles.h"
#include "preprocess/simplify/fit_attributes.h"
#include "preprocess/simplify/region_simplifier.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

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

// The root's levels are the only ones without any border, and what a whole model takes in a picture of a megapixel.
// They begin with so many triangles at most, and a third of the finest: where pixels hold fewer, levels gain little.
constexpr std::uint64_t kRootTriangles = 300'000, kRootShare = 3;

constexpr std::array kRootShares{0.68, 0.46, 0.31};

// Above so many triangles the root keeps its handles. Below, they would take more and more of what is left.
constexpr std::uint64_t kKeepTopology = 20'000;

// Samples of the surface for each triangle that stands for it, at most.
constexpr std::size_t kSamples = 8;

// Where fewer of the finest triangles are to one of a level, there is little between its vertices to fit.
constexpr std::size_t kLeastSamples = 2;

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
        sample_surface();
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
        samples_ = {};
        RegionLods result;
        result.level_begin.push_back(0);
        for (const std::vector<RegionLevel>& node : levels_) {
            for (const RegionLevel& level : node) {
                result.levels.push_back({result.indices.size(),
                                         static_cast<std::uint32_t>(level.triangles.corners.size()),
                                         static_cast<float>(std::max(level.shape_error, level.looks_error))});
                append(clustered(level.triangles), static_cast<std::uint32_t>(result.vertices.size()), result.indices);
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

    // Of either a Left or a level.
    struct RegionView {
        const RegionTriangles* triangles;
        double shape_error, looks_error;
    };
    template <typename Part>
    static RegionView view_of(const Part& part) {
        return {&part.triangles, part.shape_error, part.looks_error};
    }

    struct Context {
        RegionSimplifier& simplifier;
        std::span<const std::uint8_t> shared;
    };

    void simplify_depth(std::uint32_t begin, std::uint32_t end) {
        if (begin == 0)
            collect_root();
        else
            tbb::parallel_for(begin, end, [&](std::uint32_t node) { collect(node); });
        const std::vector<std::uint8_t> shared = find_shared(begin, end);
        tbb::enumerable_thread_specific<RegionSimplifier> simplifiers(
            [&] { return RegionSimplifier(mesh_, vertices_, shared); });
        tbb::parallel_for(begin, end, [&](std::uint32_t index) {
            if (!has_levels(index)) return;
            const Context context{simplifiers.local(), shared};
            if (index != 0)
                simplify_node(index, context, kShares, true);
            else
                simplify_root(context);
        });
    }

    void simplify_root(const Context& context) {
        bool keep_topology = true;
        while (left_[0].triangles.corners.size() > 3 * kFewest) {
            keep_topology = keep_topology && left_[0].triangles.corners.size() > 3 * kKeepTopology;
            if (simplify_node(0, context, kRootShares, keep_topology)) continue;
            if (!keep_topology) break;
            keep_topology = false;
        }
    }

    // False if it did not get far.
    bool simplify_node(std::uint32_t index, const Context& context, std::span<const double> shares,
                       bool keep_topology) {
        Left& left = left_[index];
        const auto before = static_cast<double>(left.triangles.corners.size());
        const double below = left.shape_error;
        std::vector<RegionLevel> coarser = context.simplifier.simplify(left.triangles, shares, keep_topology);
        if (coarser.empty()) return false;
        for (RegionLevel& level : coarser) {
            // Distances of one step and another are independent: squares add up. What was filtered is filtered again.
            level.shape_error = left.shape_error = std::max(left.shape_error, std::hypot(level.shape_error, below));
            level.looks_error = left.looks_error = std::max(left.looks_error, level.looks_error);
        }
        // A thread that waits must not begin another node meanwhile: that would take this one's simplifier.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(std::size_t{0}, coarser.size(), [&](std::size_t i) {
                RegionTriangles& triangles = coarser[i].triangles;
                const std::size_t count = triangles.corners.size() / 3;
                if (samples_of(index).size() < kLeastSamples * count) return;
                fit_attributes(mesh_, vertices_, samples_of(index), kSamples * count, context.shared, triangles);
            });
        });
        left.triangles = coarser.back().triangles;
        const bool got_somewhere = static_cast<double>(left.triangles.corners.size()) < kGetsSomewhere * before;
        if (got_somewhere) std::ranges::move(coarser, std::back_inserter(levels_[index]));
        return got_somewhere;
    }

    // With the corners in another order: triangles that lie together and face the same way follow one another.
    RegionTriangles clustered(RegionTriangles triangles) const {
        std::vector<ClusteredTriangle> items;
        const auto at = [&](std::uint32_t corner) -> const Vec3f& {
            const std::uint32_t index = triangles.corners[corner];
            return mesh_
                .positions[index < first_own() ? vertices_.position[index] : triangles.position[index - first_own()]];
        };
        for (std::uint32_t corner = 0; corner < triangles.corners.size(); corner += 3)
            items.push_back(clustered_triangle(at(corner), at(corner + 1), at(corner + 2)));
        std::vector<std::uint32_t> corners;
        corners.reserve(triangles.corners.size());
        for (const std::uint32_t triangle : cluster_order(items))
            for (std::uint32_t k = 0; k < 3; ++k)
                corners.push_back(triangles.corners[3 * triangle + k]);
        triangles.corners = std::move(corners);
        return triangles;
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
            add(view_of(left_[child]), left);
            left_[child] = {};
        }
        for (std::uint32_t place = 0; node.child_count == 0 && place < node.patch_count; ++place)
            add_finest(node.first_patch + place, left.triangles);
    }

    void add(const RegionView& from, Left& to) const {
        RegionTriangles& all = to.triangles;
        append(*from.triangles, static_cast<std::uint32_t>(all.vertices.size()), all.corners);
        all.vertices.insert(all.vertices.end(), from.triangles->vertices.begin(), from.triangles->vertices.end());
        all.position.insert(all.position.end(), from.triangles->position.begin(), from.triangles->position.end());
        to.shape_error = std::max(to.shape_error, from.shape_error);
        to.looks_error = std::max(to.looks_error, from.looks_error);
    }

    void add_finest(std::uint32_t place, RegionTriangles& to) const {
        for (const std::uint32_t triangle : triangles_of(place))
            for (std::size_t k = 0; k < 3; ++k)
                to.corners.push_back(vertices_.indices[std::size_t{3} * triangle + k]);
    }

    // The whole as it is within the least error for which that is few enough, or within any.
    void collect_root() {
        std::vector<double> errors{0};
        for (const std::vector<RegionLevel>& levels : levels_)
            for (const RegionLevel& level : levels)
                errors.push_back(error_of(view_of(level)));
        std::ranges::sort(errors);
        const auto has_too_many = [&](double error) {
            std::uint64_t triangles = 0;
            visit_within(
                0, error, [&](const RegionView& part) { triangles += part.triangles->corners.size() / 3; },
                [&](std::uint32_t place) { triangles += triangles_of(place).size(); });
            return triangles > std::min(kRootTriangles, mesh_.triangles.size() / kRootShare);
        };
        const auto least = std::ranges::partition_point(errors, has_too_many);
        for (Left& left : left_)
            left = {};
        visit_within(
            0, least == errors.end() ? errors.back() : *least, [&](const RegionView& part) { add(part, left_[0]); },
            [&](std::uint32_t place) { add_finest(place, left_[0].triangles); });
    }

    static double error_of(const RegionView& part) { return std::max(part.shape_error, part.looks_error); }

    // The uppermost nodes with levels within an error, the coarsest such level of each, and the octree's places that
    // are in none.
    template <typename Part, typename Finest>
    void visit_within(std::uint32_t index, double error, const Part& part, const Finest& finest) const {
        const std::vector<RegionLevel>& levels = levels_[index];
        const auto coarser = std::ranges::partition_point(
            levels, [&](const RegionLevel& level) { return error_of(view_of(level)) <= error; });
        if (coarser != levels.begin()) return part(view_of(coarser[-1]));
        const format::OctreeNode& node = octree_[index];
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child)
            visit_within(child, error, part, finest);
        for (std::uint32_t place = 0; node.child_count == 0 && place < node.patch_count; ++place)
            finest(node.first_patch + place);
    }

    // Samples of all places' surfaces, one place after the other.
    void sample_surface() {
        sample_begin_.push_back(0);
        for (std::uint32_t place = 0; place < order_.size(); ++place)
            sample_begin_.push_back(sample_begin_.back() + triangles_of(place).size());
        samples_.resize(sample_begin_.back());
        tbb::parallel_for(std::size_t{0}, order_.size(), [&](std::size_t place) {
            SurfaceSample* sample = samples_.data() + sample_begin_[place];
            for (const std::uint32_t triangle : triangles_of(static_cast<std::uint32_t>(place)))
                *sample++ = sample_triangle(mesh_, vertices_, triangle);
        });
    }

    std::span<const SurfaceSample> samples_of(std::uint32_t index) const {
        const format::OctreeNode& node = octree_[index];
        const std::size_t begin = sample_begin_[node.first_patch];
        return std::span(samples_).subspan(begin, sample_begin_[node.first_patch + node.patch_count] - begin);
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
    std::vector<SurfaceSample> samples_;
    std::vector<std::size_t> sample_begin_;  // of each place; one more
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
