// Greedy contraction of the dual graph (Ni 2005, algorithm 3.2): contract the cheapest pair of neighbours until none
// costs at most the threshold. The order is that of the naive algorithm, which compares all pairs at each step by
// (cost, lower slot, higher slot); the queue only makes it O(n log n).
//
// A Metric says what pairs cost and keeps the clusters' additive data, a < b:
//   float bound(a, b, length)   a lower bound of the cost, or kNever; cheap
//   float cost(a, b, bound)     the cost, at least the bound, or kNever; computed only when the pair reaches the top
//   void merge(a, b, length)    a becomes the union; b is gone
//   void prefetch(slot)         starts loading the cluster's data
// kNever excludes a pair for as long as neither cluster changes.
#pragma once

#include "preprocess/cluster/cluster_graph.h"
#include "preprocess/cluster/pair_queue.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace splice {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

/// Contracts `graph` while the cheapest pair costs at most `threshold`. `eligible(slot)` tells who may take part;
/// `tick(n)` is called after n merges, some 200 times. Returns the number of merges.
template <class Metric, class Eligible, class Tick>
std::size_t contract(ClusterGraph& graph, Metric& metric, float threshold, std::uint32_t phase,
                     const Eligible& eligible, const Tick& tick) {
    const float limit = std::min(threshold, std::numeric_limits<float>::max());  // kNever is above it
    // Versions only grow, so a pair whose stamp is not the current one has seen a cluster change. Odd: cost, not bound.
    const auto stamp_of = [&](std::uint32_t a, std::uint32_t b) { return 2 * (graph.version(a) + graph.version(b)); };
    const auto stale = [&](const QueuedPair& pair) { return (pair.stamp & ~1u) != stamp_of(pair.a(), pair.b); };

    const auto prefetch = [&](std::uint32_t slot) {
        graph.prefetch(slot);
        metric.prefetch(slot);
    };

    PairQueue queue;
    const auto offer = [&](std::uint32_t a, std::uint32_t b, float length) {
        const float bound = metric.bound(a, b, length);
        if (bound <= limit) queue.push({bound, a, b, stamp_of(a, b)});
    };
    for (std::uint32_t a = 0; a < graph.slots(); ++a) {
        if (!graph.alive(a) || !eligible(a)) continue;
        for (const ClusterLink& l : graph.links(a)) {
            if (l.slot > a && eligible(l.slot)) offer(a, l.slot, l.length);
        }
    }

    const std::size_t tick_every = graph.slots() / 200 + 1;
    std::size_t merges = 0;
    while (const QueuedPair* top = queue.top(stale)) {
        const float key = top->cost();
        const std::uint32_t a = top->a(), b = top->b, stamp = top->stamp;
        queue.pop();
        if (stamp % 2 == 0) {
            const float cost = metric.cost(a, b, key);
            if (cost > key) {
                if (cost <= limit) queue.push({cost, a, b, stamp + 1});
                continue;
            }
        }
        // Contraction hops about in memory: ask early for what it needs of the neighbours and of the next pair.
        for (const std::uint32_t slot : {a, b}) {
            for (const ClusterLink& l : graph.links(slot))
                prefetch(l.slot);
        }
        if (const QueuedPair* next = queue.peek()) {
            prefetch(next->a());
            prefetch(next->b);
        }
        metric.merge(a, b, graph.border(a, b));
        graph.merge(a, b, key, phase);
        for (const ClusterLink& l : graph.links(a)) {
            if (eligible(l.slot)) offer(std::min(a, l.slot), std::max(a, l.slot), l.length);
        }
        if (++merges % tick_every == 0) tick(merges);
    }
    return merges;
}

}  // namespace splice
