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
#include <tuple>

namespace splice {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

/// Contracts `graph` while the cheapest pair costs at most `threshold`. `eligible(slot)` tells who may take part;
/// `tick(n)` is called some 200 times, with the number of merges in the tree. Returns the number of merges.
///
/// Each pair is looked after by the cluster of the two that changed last (the lower slot if neither has), and only the
/// first of the pairs that a cluster looks after waits in the queue. It stays a lower bound for the others: they were
/// there when it was chosen, and can only fall to neighbours that change. So a merge queues one pair, not six.
template <class Metric, class Eligible, class Tick>
std::size_t contract(ClusterGraph& graph, Metric& metric, float threshold, std::uint32_t phase,
                     const Eligible& eligible, const Tick& tick) {
    const float limit = std::min(threshold, std::numeric_limits<float>::max());  // kNever is above it
    const auto prefetch = [&](std::uint32_t slot) {
        graph.prefetch(slot);
        metric.prefetch(slot);
    };

    PairQueue queue(graph.slots());
    /// Queues the first pair that `owner` looks after, of those beyond `passed`.
    const auto offer_next = [&](std::uint32_t owner, const QueuedPair& passed) {
        QueuedPair first = QueuedPair::last();
        // All at once: branches that depend on one neighbour's data would hold up the next one's.
        for (const ClusterLink& l : graph.links(owner))
            metric.prefetch(l.slot);
        for (const ClusterLink& l : graph.links(owner)) {
            const bool looks_after =
                std::tuple(graph.changed(l.slot), owner) < std::tuple(graph.changed(owner), l.slot);
            if (!looks_after || !eligible(l.slot)) continue;
            const auto [a, b] = std::minmax(owner, l.slot);
            const float bound = metric.bound(a, b, l.length);
            if (!(bound <= limit)) continue;
            const QueuedPair pair(bound, a, b, owner, graph.now());
            if (passed < pair && pair < first) first = pair;
        }
        if (first < QueuedPair::last()) queue.push(first);
    };
    for (std::uint32_t a = 0; a < graph.slots(); ++a) {
        if (graph.alive(a) && eligible(a)) offer_next(a, QueuedPair::first());
    }

    // Contraction hops about in memory: ask early for what the next pairs need.
    const auto prefetch_next = [&] {
        const auto next = queue.peek();
        if (next.empty()) return;
        for (const std::uint32_t slot : {next[0].a(), next[0].b()}) {
            for (const ClusterLink& l : graph.links(slot))
                prefetch(l.slot);
        }
        for (const QueuedPair& later : next.subspan(1)) {
            prefetch(later.a());
            prefetch(later.b());
        }
    };
    const auto stale = [&](const QueuedPair& pair) { return graph.changed(pair.owner()) > pair.time(); };
    const std::size_t tick_every = graph.slots() / 200 + 1;
    std::size_t merges = 0;
    while (const QueuedPair* top = queue.top(stale)) {
        const QueuedPair pair = *top;
        queue.pop();
        prefetch_next();
        const std::uint32_t a = pair.a(), b = pair.b();
        if (graph.changed(pair.other()) > pair.time()) {
            if (!pair.exact()) offer_next(pair.owner(), pair);
            continue;
        }
        if (!pair.exact()) {
            const float cost = metric.cost(a, b, pair.cost());
            if (cost > pair.cost()) {
                if (cost <= limit) queue.push(QueuedPair(cost, a, b, pair.owner(), pair.time(), true));
                offer_next(pair.owner(), pair);
                continue;
            }
        }
        metric.merge(a, b, graph.merge(a, b, pair.cost(), phase));
        offer_next(a, QueuedPair::first());
        if (++merges % tick_every == 0) tick(graph.tree().size());
    }
    return merges;
}

}  // namespace splice
