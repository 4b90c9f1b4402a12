// The state that both phases contract: clusters, who touches whom along what length, and the tree of merges so far.
//
// A cluster lives in the lowest slot of what it was merged from; merging a and b, a < b, leaves the result in a.
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
    ClusterGraph() = default;
    /// Of single faces.
    explicit ClusterGraph(const FaceGraph& faces);
    /// Of clusters that stand for `nodes` of a tree with so many leaves and merges so far; `links` between them, in
    /// slots.
    ClusterGraph(std::vector<std::uint32_t> nodes, std::span<const FaceGraph::Link> links, std::size_t leaves,
                 std::vector<format::MergeNode> tree = {});

    std::size_t slots() const { return slots_.size(); }
    bool alive(std::uint32_t slot) const { return slots_[slot].parent == slot; }
    /// The slot that a merged cluster went into, lower than its own; a live one's is its own.
    std::uint32_t merged_into(std::uint32_t slot) const { return slots_[slot].parent; }
    /// Neighbours in no order.
    std::span<const ClusterLink> links(std::uint32_t slot) const {
        return {arena_.data() + slots_[slot].block * kQuad, slots_[slot].size};
    }
    /// Starts loading what merging into or beside `slot` will touch.
    void prefetch(std::uint32_t slot) const {
        __builtin_prefetch(&slots_[slot], 1);
        __builtin_prefetch(&changed_[slot], 1);
        __builtin_prefetch(&arena_[(slot * kQuad) << first_class_], 1);  // where its list began, and mostly still is
    }
    /// Merges so far, the time.
    std::uint32_t now() const { return static_cast<std::uint32_t>(tree_.size()); }
    /// When the slot took part in a merge last, 0 for never: what was computed at an earlier time is stale.
    std::uint32_t changed(std::uint32_t slot) const { return changed_[slot]; }
    /// The node of the merge tree that the next merge will make; those of the leaves come first.
    std::uint32_t next_node() const { return static_cast<std::uint32_t>(leaves_ + tree_.size()); }
    /// The node of the merge tree that stands for the cluster.
    std::uint32_t node(std::uint32_t slot) const { return node_[slot]; }
    const std::vector<format::MergeNode>& tree() const { return tree_; }
    std::vector<format::MergeNode> take_tree() { return std::move(tree_); }

    /// Merges b into a, a < b, which must be neighbours, and records it. Returns the length of their border.
    float merge(std::uint32_t a, std::uint32_t b, float cost, std::uint32_t phase);

  private:
    // Lists are blocks of 4 * 2^size_class links in one arena; freed blocks are kept by size.
    static constexpr std::size_t kQuad = 4;
    struct alignas(16) Slot {
        std::uint32_t block;  // in units of kQuad links
        std::uint32_t size;
        std::uint32_t size_class;
        std::uint32_t parent;  // the slot itself while alive
    };
    ClusterLink* first_link(const Slot& slot) { return arena_.data() + slot.block * kQuad; }
    void append(Slot& slot, const ClusterLink& link);
    void grow(Slot& slot, std::uint32_t size);
    bool redirect(std::uint32_t slot, std::uint32_t from, std::uint32_t to);

    std::size_t leaves_ = 0;
    std::uint32_t first_class_ = 0;  // size class that lists start with
    std::vector<ClusterLink> arena_;
    std::vector<std::vector<std::uint32_t>> free_;  // blocks by size class
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> changed_;  // by slot; apart, because it is asked for most and so stays in cache
    std::vector<std::uint32_t> node_;     // by slot
    std::vector<format::MergeNode> tree_;
};

}  // namespace splice
