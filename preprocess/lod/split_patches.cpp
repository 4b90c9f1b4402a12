#include "preprocess/lod/split_points.h"

#include <tbb/parallel_for.h>

namespace splice {
namespace {

// What a node is made of: a node of the patch octree, a patch, or a node of a patch's own split. A patch is the root of
// its split.
struct Source {
    enum class Kind { kOctree, kPatch } kind;
    std::uint32_t index;
    std::uint32_t below = 0;  // kPatch: node of its split
};

class PatchSplitter {
  public:
    PatchSplitter(std::span<const format::Surfel> surfels, std::span<const format::Patch> patches,
                  std::span<const format::OctreeNode> octree)
        : surfels_(surfels), patches_(patches), octree_(octree), splits_(patches.size()) {}

    PointSplit split() {
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t patch) {
            if (patches_[patch].surfel_count != 0)
                splits_[patch] = split_points(
                    positions_of(surfels_.subspan(patches_[patch].first_surfel, patches_[patch].surfel_count)));
        });
        PointSplit result;
        result.order.resize(surfels_.size());
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t patch) {
            const auto first = static_cast<std::uint32_t>(patches_[patch].first_surfel);
            for (std::uint32_t i = 0; i < patches_[patch].surfel_count; ++i)
                result.order[first + i] = first + splits_[patch].order[i];
        });
        std::vector<Source> sources{descend({Source::Kind::kOctree, 0})};
        result.nodes.push_back(node_of(sources.front()));
        result.level_begin = {0, 1};
        for (std::uint32_t index = 0; index < result.nodes.size(); ++index) {
            if (index == result.level_begin.back())
                result.level_begin.push_back(static_cast<std::uint32_t>(result.nodes.size()));
            const std::vector<Source> children = children_of(sources[index]);
            if (children.empty()) continue;
            result.nodes[index].first_child = static_cast<std::uint32_t>(result.nodes.size());
            result.nodes[index].child_count = static_cast<std::uint8_t>(children.size());
            for (const Source& child : children) {
                sources.push_back(descend(child));
                result.nodes.push_back(node_of(sources.back()));
            }
        }
        return result;
    }

  private:
    std::uint32_t surfels_of(const format::OctreeNode& node) const {
        const format::Patch& last = patches_[node.first_patch + node.patch_count - 1];
        return static_cast<std::uint32_t>(last.first_surfel + last.surfel_count -
                                          patches_[node.first_patch].first_surfel);
    }

    std::vector<Source> children_of(const Source& source) const {
        std::vector<Source> children;
        if (source.kind == Source::Kind::kPatch) {
            const format::PointNode& node = splits_[source.index].nodes[source.below];
            for (std::uint32_t child = 0; child < node.child_count; ++child)
                children.push_back({Source::Kind::kPatch, source.index, node.first_child + child});
            return children;
        }
        const format::OctreeNode& node = octree_[source.index];
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child)
            if (surfels_of(octree_[child]) != 0) children.push_back({Source::Kind::kOctree, child});
        for (std::uint32_t i = 0; node.child_count == 0 && i < node.patch_count; ++i)
            if (patches_[node.first_patch + i].surfel_count != 0)
                children.push_back({Source::Kind::kPatch, node.first_patch + i});
        return children;
    }

    // Nodes of the octree that would have one child are left out.
    Source descend(Source source) const {
        while (source.kind == Source::Kind::kOctree) {
            const std::vector<Source> children = children_of(source);
            if (children.size() != 1) break;
            source = children.front();
        }
        return source;
    }

    format::PointNode node_of(const Source& source) const {
        format::PointNode node{};
        if (source.kind == Source::Kind::kPatch) {
            const format::PointNode& own = splits_[source.index].nodes[source.below];
            node.first_surfel = static_cast<std::uint32_t>(patches_[source.index].first_surfel) + own.first_surfel;
            node.surfel_count = own.surfel_count;
        } else {
            node.first_surfel = static_cast<std::uint32_t>(patches_[octree_[source.index].first_patch].first_surfel);
            node.surfel_count = surfels_of(octree_[source.index]);
        }
        return node;
    }

    std::span<const format::Surfel> surfels_;
    std::span<const format::Patch> patches_;
    std::span<const format::OctreeNode> octree_;
    std::vector<PointSplit> splits_;  // of each patch
};

}  // namespace

PointSplit split_patches(std::span<const format::Surfel> surfels, std::span<const format::Patch> patches,
                         std::span<const format::OctreeNode> octree) {
    return PatchSplitter(surfels, patches, octree).split();
}

}  // namespace splice
