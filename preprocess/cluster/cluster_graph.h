// The state that both phases contract: clusters, who touches whom along what length, and the tree of merges so far.
//
// A cluster lives in the slot of its first face (in FaceGraph order); merging a and b, a < b, leaves the result in a.
#pragma once

#include "preprocess/cluster/face_graph.h"
#include "preprocess/model_format/model_format.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

struct ClusterLink {
    std::uint32_t slot;  // the neighbour
    float length;        // of the common border, unit-box units
};

class ClusterGraph {
  public:
    explicit ClusterGraph(const FaceGraph& faces);

    std::size_t slots() const { return parent_.size(); }
    bool alive(std::uint32_t slot) const { return parent_[slot] == slot; }
    /// The slot that a merged cluster went into, lower than its own; a live one's is its own.
    std::uint32_t merged_into(std::uint32_t slot) const { return parent_[slot]; }
    /// Neighbours in ascending order of slot.
    std::span<const ClusterLink> links(std::uint32_t slot) const {
        return {arena_.data() + lists_[slot].begin * kQuad, lists_[slot].size};
    }
    /// Counts the merges that touched the slot; what was computed for another version is stale.
    std::uint32_t version(std::uint32_t slot) const { return version_[slot]; }
    std::uint32_t node(std::uint32_t slot) const { return node_[slot]; }
    const std::vector<format::MergeNode>& tree() const { return tree_; }
    std::vector<format::MergeNode> take_tree() { return std::move(tree_); }

    /// Merges b into a, a < b, which must be neighbours, and records it.
    void merge(std::uint32_t a, std::uint32_t b, float cost, std::uint32_t phase);

  private:
    // Lists are blocks of 4 * 2^size_class links in one arena; freed blocks are kept by size.
    static constexpr std::size_t kQuad = 4;
    struct List {
        std::uint32_t begin = 0;  // in quads
        std::uint32_t size = 0;
        std::uint8_t size_class = 0;
    };
    std::uint32_t allocate(std::uint8_t size_class);
    void store(std::uint32_t slot, std::span<const ClusterLink> links);
    void release(List& list);
    void rename_neighbour(std::uint32_t slot, std::uint32_t from, std::uint32_t to);

    std::vector<ClusterLink> arena_;
    std::vector<std::vector<std::uint32_t>> free_;  // by size class
    std::vector<List> lists_;
    std::vector<std::uint32_t> parent_;  // slot itself while alive
    std::vector<std::uint32_t> version_;
    std::vector<std::uint32_t> node_;  // of the merge tree
    std::vector<format::MergeNode> tree_;
    std::vector<ClusterLink> merged_;  // scratch
};

}  // namespace splice
