#include "engine/scene/node_boxes.h"

#include <algorithm>
#include <limits>

namespace splice {

namespace {

class Boxes {
  public:
    Boxes(const DrawnNodes& drawn, const PatchView& seen, double small_px)
        : drawn_(drawn), seen_(seen), small_px_(small_px) {}

    std::vector<NodeBox> all() {
        if (!drawn_.octree.empty()) visit_octree(0, 1);
        if (!drawn_.cut.runs.empty()) {
            begins_.reserve(drawn_.cut.runs.size());
            for (const CutRun& run : drawn_.cut.runs)
                begins_.push_back(run.inner ? drawn_.hierarchy.first_surfel[run.first] : run.first);
            visit_tree(0, 1);
        }
        return std::move(boxes_);
    }

  private:
    void visit_octree(std::uint32_t index, std::uint32_t level) {
        const format::OctreeNode& node = drawn_.octree[index];
        bool shown = !drawn_.groups.empty() && drawn_.groups[index];
        if (!shown) {
            // Patches that are of no child.
            std::uint32_t next = node.first_patch;
            for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child) {
                const format::OctreeNode& below = drawn_.octree[child];
                shown = shown || draws_any(next, below.first_patch);
                next = below.first_patch + below.patch_count;
                visit_octree(child, level + 1);
            }
            shown = shown || draws_any(next, node.first_patch + node.patch_count);
        }
        if (!shown) return;
        NodeBox box{.low = {}, .high = {}, .level = level};
        std::copy_n(node.bounds_min, 3, box.low);
        std::copy_n(node.bounds_max, 3, box.high);
        boxes_.push_back(box);
    }

    bool draws_any(std::uint32_t first, std::uint32_t end) const {
        const auto last = drawn_.patches.begin() + end;
        return std::find(drawn_.patches.begin() + first, last, true) != last;
    }

    void visit_tree(std::uint32_t node, std::uint32_t level) {
        const PointHierarchy& tree = drawn_.hierarchy;
        const CutRun* run = run_at(node);
        if (run == nullptr) return;
        const bool chosen = run->inner && node >= run->first && node - run->first < run->count;
        if (chosen || tree.child_counts[node] == 0 || is_small(node)) {
            NodeBox box{.low = {}, .high = {}, .level = level};
            std::fill_n(box.low, 3, std::numeric_limits<float>::max());
            std::fill_n(box.high, 3, std::numeric_limits<float>::lowest());
            extend(box, node);
            boxes_.push_back(box);
            return;
        }
        for (std::uint32_t child = 0; child < tree.child_counts[node]; ++child)
            visit_tree(tree.first_child[node] + child, level + 1);
    }

    // The first run with surfels of a node; null: none has.
    const CutRun* run_at(std::uint32_t node) const {
        const std::uint32_t begin = drawn_.hierarchy.first_surfel[node],
                            end = begin + drawn_.hierarchy.surfel_counts[node];
        auto next = static_cast<std::size_t>(std::upper_bound(begins_.begin(), begins_.end(), begin) - begins_.begin());
        if (next > 0 && end_of(drawn_.cut.runs[next - 1]) > begin) return &drawn_.cut.runs[next - 1];
        return next < begins_.size() && begins_[next] < end ? &drawn_.cut.runs[next] : nullptr;
    }

    std::uint32_t end_of(const CutRun& run) const {
        if (!run.inner) return run.first + run.count;
        const std::uint32_t last = run.first + run.count - 1;
        return drawn_.hierarchy.first_surfel[last] + drawn_.hierarchy.surfel_counts[last];
    }

    bool is_small(std::uint32_t node) const {
        const PointHierarchy& tree = drawn_.hierarchy;
        const float radius = tree.radius[node];
        const float low[3] = {tree.x[node] - radius, tree.y[node] - radius, tree.z[node] - radius};
        const float high[3] = {tree.x[node] + radius, tree.y[node] + radius, tree.z[node] + radius};
        return seen_.within(2 * static_cast<double>(radius), small_px_, seen_.locate(low, high));
    }

    void extend(NodeBox& box, std::uint32_t node) const {
        const PointHierarchy& tree = drawn_.hierarchy;
        for (std::uint32_t child = 0; child < tree.child_counts[node]; ++child)
            extend(box, tree.first_child[node] + child);
        if (tree.child_counts[node] != 0) return;
        const float centre[3] = {tree.x[node], tree.y[node], tree.z[node]};
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], centre[axis] - tree.radius[node]);
            box.high[axis] = std::max(box.high[axis], centre[axis] + tree.radius[node]);
        }
    }

    const DrawnNodes& drawn_;
    const PatchView& seen_;
    double small_px_;
    std::vector<std::uint32_t> begins_;  // the first surfel of each run
    std::vector<NodeBox> boxes_;
};

}  // namespace

std::vector<NodeBox> node_boxes(const DrawnNodes& drawn, const PatchView& seen, double small_px) {
    return Boxes(drawn, seen, small_px).all();
}

}  // namespace splice
