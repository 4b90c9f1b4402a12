#include "preprocess/cluster/contract_blocks.h"

#include "preprocess/cluster/merge_heap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

namespace splice {
namespace {

constexpr std::uint32_t kPhase = 1;

/// A run of slots of the level.
struct Block {
    std::uint32_t first = 0, last = 0;         // slots
    std::size_t link_begin = 0, link_end = 0;  // links whose slot[0] is in the block
    ClusterGraph graph;                        // its slots count from `first`
    std::vector<Cluster> clusters;             // after contraction, by slot of the graph
    std::uint32_t first_new_slot = 0;          // in the next level
    std::uint32_t new_slots = 0;
    std::size_t first_merge = 0;         // of its own among all blocks'
    std::vector<FaceGraph::Link> links;  // of the next level, whose slot[0] is in the block
};

template <class T>
std::vector<T> slice(const std::vector<T>& all, std::size_t first, std::size_t last) {
    return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last)};
}

class BlockContraction {
  public:
    BlockContraction(const ClusterLevel& level, std::uint32_t block)
        : level_(level),
          leaves_(level.slot_of_face.size()),
          first_new_node_(static_cast<std::uint32_t>(leaves_ + level.tree.size())),
          blocks_((level.nodes.size() + block - 1) / block) {
        const auto slots = static_cast<std::uint32_t>(level.nodes.size());
        for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
            blocks_[b].first = b * block;
            blocks_[b].last = std::min(slots, (b + 1) * block);
            blocks_[b].link_begin = first_link_of(blocks_[b].first);
            blocks_[b].link_end = first_link_of(blocks_[b].last);
        }
    }

    ClusterLevel run(const ClusterLimits& limits, float threshold) {
        for_each_block([&](Block& block) { contract_block(block, limits, threshold); });
        number();
        ClusterLevel next;
        next.clusters.resize(next_slots_);
        next.rough.resize(next_slots_);
        next.nodes.resize(next_slots_);
        next.tree = level_.tree;
        next.tree.resize(level_.tree.size() + merges_);
        next.slot_of_face.resize(leaves_);
        for_each_block([&](Block& block) { join_clusters(block, next); });
        // Links need the new slots of all blocks.
        for_each_block([&](Block& block) { join_links(block); });
        for (const Block& block : blocks_)
            next.links.insert(next.links.end(), block.links.begin(), block.links.end());
        tbb::parallel_for(std::size_t{0}, leaves_,
                          [&](std::size_t face) { next.slot_of_face[face] = new_slot_[level_.slot_of_face[face]]; });
        return next;
    }

  private:
    template <class Do>
    void for_each_block(const Do& work) {
        tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) { work(blocks_[b]); });
    }
    std::size_t first_link_of(std::uint32_t slot) const {
        const auto at = std::lower_bound(level_.links.begin(), level_.links.end(), slot,
                                         [](const FaceGraph::Link& l, std::uint32_t s) { return l.slot[0] < s; });
        return static_cast<std::size_t>(at - level_.links.begin());
    }

    void contract_block(Block& block, const ClusterLimits& limits, float threshold) const {
        std::vector<FaceGraph::Link> links;
        links.reserve(block.link_end - block.link_begin);
        for (std::size_t l = block.link_begin; l < block.link_end; ++l) {
            const auto [slots, length] = level_.links[l];
            if (slots[1] < block.last) links.push_back({{slots[0] - block.first, slots[1] - block.first}, length});
        }
        block.graph = ClusterGraph(slice(level_.nodes, block.first, block.last), links, first_new_node_);
        ClusterTable table(slice(level_.clusters, block.first, block.last));
        const std::vector<std::uint8_t> rough = slice(level_.rough, block.first, block.last);
        FlatnessMetric metric(table, rough, limits);
        contract(
            block.graph, metric, threshold, kPhase, [](std::uint32_t) { return true; }, [](std::size_t) {});
        block.clusters = table.take();
    }

    /// Slots of the next level, along the curve as before, and places in the tree, block after block.
    void number() {
        for (Block& block : blocks_) {
            block.first_new_slot = next_slots_;
            block.first_merge = merges_;
            merges_ += block.graph.tree().size();
            next_slots_ += block.last - block.first - static_cast<std::uint32_t>(block.graph.tree().size());
        }
        new_slot_.resize(level_.nodes.size());
    }

    void join_clusters(const Block& block, ClusterLevel& next) {
        // Blocks number the nodes that they make from first_new_node_ on, each for itself.
        const auto node = [&](std::uint32_t n) {
            return n < first_new_node_ ? n : n + static_cast<std::uint32_t>(block.first_merge);
        };
        std::uint32_t fresh = block.first_new_slot;
        for (std::uint32_t s = 0; s < block.last - block.first; ++s) {
            if (!block.graph.alive(s)) {
                new_slot_[block.first + s] = new_slot_[block.first + block.graph.merged_into(s)];
                continue;
            }
            new_slot_[block.first + s] = fresh;
            next.clusters[fresh] = block.clusters[s];
            next.rough[fresh] = level_.rough[block.first + s];
            next.nodes[fresh++] = node(block.graph.node(s));
        }
        auto merge = next.tree.begin() + static_cast<std::ptrdiff_t>(level_.tree.size() + block.first_merge);
        for (const format::MergeNode& m : block.graph.tree())
            *merge++ = {{node(m.child[0]), node(m.child[1])}, m.cost, m.phase};
    }

    void join_links(Block& block) const {
        std::vector<FaceGraph::Link>& links = block.links;
        for (std::uint32_t s = 0; s < block.last - block.first; ++s) {
            if (!block.graph.alive(s)) continue;
            for (const ClusterLink& l : block.graph.links(s)) {
                if (l.slot > s)
                    links.push_back({{new_slot_[block.first + s], new_slot_[block.first + l.slot]}, l.length});
            }
        }
        for (std::size_t l = block.link_begin; l < block.link_end; ++l) {
            const auto [slots, length] = level_.links[l];
            if (slots[1] >= block.last) links.push_back({{new_slot_[slots[0]], new_slot_[slots[1]]}, length});
        }
        // By length, too, so that the sums of lengths across blocks do not depend on how equal ones were sorted.
        std::sort(links.begin(), links.end(), [](const FaceGraph::Link& x, const FaceGraph::Link& y) {
            return std::tuple(x.slot[0], x.slot[1], x.length) < std::tuple(y.slot[0], y.slot[1], y.length);
        });
        std::size_t kept = 0;
        for (const FaceGraph::Link& l : links) {
            if (kept > 0 && links[kept - 1].slot[0] == l.slot[0] && links[kept - 1].slot[1] == l.slot[1]) {
                links[kept - 1].length += l.length;
            } else {
                links[kept++] = l;
            }
        }
        links.resize(kept);
        block.graph = {};
    }

    const ClusterLevel& level_;
    std::size_t leaves_;
    std::uint32_t first_new_node_;
    std::vector<Block> blocks_;
    std::uint32_t next_slots_ = 0;
    std::size_t merges_ = 0;
    std::vector<std::uint32_t> new_slot_;  // by slot of the level
};

}  // namespace

ClusterLevel contract_blocks(const ClusterLevel& level, const ClusterLimits& limits, float threshold,
                             std::uint32_t block) {
    return BlockContraction(level, block).run(limits, threshold);
}

}  // namespace splice
