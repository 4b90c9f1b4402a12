// Greedy contraction of the dual graph (Ni 2005, algorithm 3.2): contract the cheapest pair of neighbours until none
// costs at most the threshold. The order is that of the naive algorithm, which compares all pairs at each step by
// (cost, lower slot, higher slot); the heap only makes it O(n log n).
//
// A Metric says what pairs cost and keeps the clusters' additive data:
//   float bound(a, b, length)   a lower bound of the cost, or kNever; cheap
//   float cost(a, b, bound)     the cost, at least the bound, or kNever; computed only when the pair reaches the top
//   void merge(a, b, length)    a becomes the union; b is gone
// kNever excludes a pair for as long as neither cluster changes.
#pragma once

#include "preprocess/cluster/cluster_graph.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace splice {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

/// A pair waiting to be contracted. Keyed by a lower bound first, by the cost once it has been at the top.
struct HeapPair {
    float key;
    std::uint32_t a, b;   // slots, a < b
    std::uint32_t stamp;  // twice the sum of the clusters' versions when pushed; versions only grow, so a stale pair
                          // shows; plus 1 if the key is the cost

    friend bool operator<(const HeapPair& x, const HeapPair& y) {
        if (x.key != y.key) return x.key < y.key;
        return x.a != y.a ? x.a < y.a : x.b < y.b;
    }
};

/// A 4-ary min-heap: half the depth of a binary one, and four children share a cache line.
class PairHeap {
  public:
    bool empty() const { return pairs_.empty(); }
    const HeapPair& top() const { return pairs_.front(); }
    std::size_t size() const { return pairs_.size(); }
    /// Adds without restoring order; call heapify() after the last.
    void append(const HeapPair& pair) { pairs_.push_back(pair); }
    void heapify() {
        if (pairs_.size() < 2) return;
        for (std::size_t i = (pairs_.size() - 2) / 4 + 1; i-- > 0;)
            sift_down(i, pairs_[i]);
    }
    void push(const HeapPair& pair) {
        std::size_t i = pairs_.size();
        pairs_.push_back(pair);
        while (i > 0 && pair < pairs_[(i - 1) / 4]) {
            pairs_[i] = pairs_[(i - 1) / 4];
            i = (i - 1) / 4;
        }
        pairs_[i] = pair;
    }
    void replace_top(const HeapPair& pair) { sift_down(0, pair); }
    void pop() {
        const HeapPair last = pairs_.back();
        pairs_.pop_back();
        if (!pairs_.empty()) sift_down(0, last);
    }

  private:
    void sift_down(std::size_t i, HeapPair pair) {
        for (;;) {
            const std::size_t first = 4 * i + 1, last = std::min(first + 4, pairs_.size());
            if (first >= last) break;
            std::size_t least = first;
            for (std::size_t c = first + 1; c < last; ++c) {
                if (pairs_[c] < pairs_[least]) least = c;
            }
            if (!(pairs_[least] < pair)) break;
            pairs_[i] = pairs_[least];
            i = least;
        }
        pairs_[i] = pair;
    }

    std::vector<HeapPair> pairs_;
};

/// Contracts `graph` while the cheapest pair costs at most `threshold`. `eligible` tells which slots may take part;
/// `tick(n)` is called after n merges, now and then. Returns the number of merges.
template <class Metric, class Eligible, class Tick>
std::size_t contract(ClusterGraph& graph, Metric& metric, float threshold, std::uint32_t phase,
                     const Eligible& eligible, const Tick& tick) {
    PairHeap heap;
    const float limit = std::min(threshold, std::numeric_limits<float>::max());  // kNever is above it
    const auto stamp_of = [&](std::uint32_t a, std::uint32_t b) { return 2 * (graph.version(a) + graph.version(b)); };
    const auto pair_of = [&](std::uint32_t a, std::uint32_t b, float key) {
        return HeapPair{key, a, b, stamp_of(a, b)};
    };
    for (std::uint32_t a = 0; a < graph.slots(); ++a) {
        if (!graph.alive(a) || !eligible(a)) continue;
        for (const ClusterLink& l : graph.links(a)) {
            if (l.slot < a || !eligible(l.slot)) continue;
            const float bound = metric.bound(a, l.slot, l.length);
            if (bound <= limit) heap.append(pair_of(a, l.slot, bound));
        }
    }
    heap.heapify();

    std::size_t merges = 0;
    while (!heap.empty()) {
        const HeapPair top = heap.top();
        const std::uint32_t stamp = stamp_of(top.a, top.b);
        if (stamp != (top.stamp & ~1u)) {
            heap.pop();
            continue;
        }
        if (top.stamp == stamp) {
            const float cost = metric.cost(top.a, top.b, top.key);
            if (cost > limit) {
                heap.pop();
                continue;
            }
            if (cost > top.key) {
                heap.replace_top({cost, top.a, top.b, stamp + 1});
                continue;
            }
        }
        heap.pop();
        const auto links = graph.links(top.a);
        const float length =
            std::lower_bound(links.begin(), links.end(), top.b, [](const ClusterLink& l, std::uint32_t s) {
                return l.slot < s;
            })->length;
        metric.merge(top.a, top.b, length);
        graph.merge(top.a, top.b, top.key, phase);
        for (const ClusterLink& l : graph.links(top.a)) {
            if (!eligible(l.slot)) continue;
            const std::uint32_t a = std::min(top.a, l.slot), b = std::max(top.a, l.slot);
            const float bound = metric.bound(a, b, l.length);
            if (bound <= limit) heap.push(pair_of(a, b, bound));
        }
        if (++merges % 4096 == 0) tick(merges);
    }
    return merges;
}

}  // namespace splice
