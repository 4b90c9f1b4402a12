// A priority queue of pairs of clusters, exact in its order and built for the way clustering uses it: a pair a
// cluster, of which many are stale when their turn comes. Pairs wait unsorted in buckets of similar cost; only the
// cheapest bucket is kept as a heap, small enough to stay in cache, and stale pairs are dropped when their bucket
// opens, before any sorting.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace splice {

/// A pair of slots, a < b < 2^31, with its cost or a lower bound of it. Ordered by (cost, a, b).
class QueuedPair {
  public:
    QueuedPair() = default;
    /// `owner` is a or b; `time` below 2^31; `exact` tells a cost from a bound. These take no part in the order.
    QueuedPair(float cost, std::uint32_t a, std::uint32_t b, std::uint32_t owner, std::uint32_t time,
               bool exact = false)
        : order_((std::uint64_t{ordered(cost)} << 32) | a),
          b_((b << 1) | (owner == b ? 1u : 0u)),
          time_((time << 1) | (exact ? 1u : 0u)) {}

    std::uint32_t a() const { return static_cast<std::uint32_t>(order_); }
    std::uint32_t b() const { return b_ >> 1; }
    std::uint32_t owner() const { return b_ & 1u ? b() : a(); }
    std::uint32_t other() const { return b_ & 1u ? a() : b(); }
    std::uint32_t time() const { return time_ >> 1; }
    bool exact() const { return (time_ & 1u) != 0; }
    float cost() const {
        const auto high = static_cast<std::uint32_t>(order_ >> 32);
        return std::bit_cast<float>(high & kSign ? high & ~kSign : ~high);
    }
    friend bool operator<(const QueuedPair& x, const QueuedPair& y) {
        return x.order_ != y.order_ ? x.order_ < y.order_ : x.b() < y.b();
    }
    /// Before and after all others.
    static QueuedPair first() { return {}; }
    static QueuedPair last() {
        QueuedPair pair;
        pair.order_ = ~std::uint64_t{0};
        return pair;
    }

  private:
    static constexpr std::uint32_t kSign = 0x80000000u;
    static std::uint32_t ordered(float cost) {
        const auto bits = std::bit_cast<std::uint32_t>(cost + 0.0f);  // no negative zero
        return bits & kSign ? ~bits : bits | kSign;
    }

    std::uint64_t order_ = 0;  // cost in the high half, so that it compares as an integer; a in the low half
    std::uint32_t b_ = 0;      // twice b, odd if b is the owner
    std::uint32_t time_ = 0;   // twice the time, odd if exact
};

class PairQueue {
  public:
    /// For about `pairs` at a time. Their number makes no difference but to speed: a chunk of each bucket that is
    /// hardly used would take more cache than the pairs do.
    explicit PairQueue(std::size_t pairs)
        : buckets_(std::clamp(std::bit_ceil(pairs / kChunk + 1), std::size_t{64}, std::size_t{1} << 12)),
          scale_(static_cast<float>(buckets_) / (kHighest - kLowest)),
          first_chunk_(buckets_, kNone),
          occupied_(buckets_ / 64, 0) {}

    void push(const QueuedPair& pair) {
        const std::size_t bucket = bucket_of(pair.cost());
        if (bucket <= open_) {
            heap_push(pair);
        } else {
            store(bucket, pair);
        }
    }

    /// The least pair that is not stale, or nullptr. `stale(pair)` may be asked more than once.
    template <class Stale>
    const QueuedPair* top(const Stale& stale) {
        for (;;) {
            while (!heap_.empty()) {
                if (!stale(heap_.front())) return &heap_.front();
                pop();
            }
            if (!open_next(stale)) return nullptr;
        }
    }

    /// The least of the pairs at hand and some that are likely to follow it, stale or not: a hint of what comes next.
    std::span<const QueuedPair> peek() const { return {heap_.data(), std::min<std::size_t>(heap_.size(), 5)}; }

    /// Removes the top.
    void pop() {
        const QueuedPair last = heap_.back();
        heap_.pop_back();
        if (!heap_.empty()) sift_down(0, last);
    }

  private:
    // Costs are of the order of 1; what lies outside shares the first or last bucket, which only costs time.
    static constexpr float kLowest = -2, kHighest = 2;
    static constexpr std::uint32_t kNone = 0xffffffffu;
    static constexpr std::size_t kChunk = 15;

    struct Chunk {
        QueuedPair pairs[kChunk];
        std::uint32_t size;
        std::uint32_t next;
    };

    std::size_t bucket_of(float cost) const {
        // The first bucket is open from the start; nothing waits in it.
        return static_cast<std::size_t>(std::clamp((cost - kLowest) * scale_, 0.0f, static_cast<float>(buckets_ - 1)));
    }

    void store(std::size_t bucket, const QueuedPair& pair) {
        std::uint32_t chunk = first_chunk_[bucket];
        if (chunk == kNone || chunks_[chunk].size == kChunk) {
            std::uint32_t fresh = free_chunk_;
            if (fresh == kNone) {
                fresh = static_cast<std::uint32_t>(chunks_.size());
                chunks_.emplace_back();
            } else {
                free_chunk_ = chunks_[fresh].next;
            }
            chunks_[fresh].size = 0;
            chunks_[fresh].next = chunk;
            first_chunk_[bucket] = chunk = fresh;
            occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
        }
        chunks_[chunk].pairs[chunks_[chunk].size++] = pair;
    }

    /// Turns the next bucket that holds anything into the heap; false when there is none.
    template <class Stale>
    bool open_next(const Stale& stale) {
        std::size_t word = (open_ + 1) / 64;
        if (word >= occupied_.size()) return false;
        std::uint64_t bits = occupied_[word] & (~std::uint64_t{0} << ((open_ + 1) % 64));
        while (bits == 0) {
            if (++word == occupied_.size()) return false;
            bits = occupied_[word];
        }
        open_ = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
        occupied_[word] &= ~(std::uint64_t{1} << (open_ % 64));
        for (std::uint32_t chunk = first_chunk_[open_]; chunk != kNone;) {
            for (std::size_t i = 0; i < chunks_[chunk].size; ++i) {
                if (!stale(chunks_[chunk].pairs[i])) heap_.push_back(chunks_[chunk].pairs[i]);
            }
            const std::uint32_t next = chunks_[chunk].next;
            chunks_[chunk].next = free_chunk_;
            free_chunk_ = chunk;
            chunk = next;
        }
        first_chunk_[open_] = kNone;
        for (std::size_t i = heap_.size() / 4 + 1; i-- > 0;) {
            if (i < heap_.size()) sift_down(i, heap_[i]);
        }
        return true;
    }

    // 4-ary: half the depth of a binary heap, and four children share a cache line.
    void heap_push(const QueuedPair& pair) {
        std::size_t i = heap_.size();
        heap_.push_back(pair);
        while (i > 0 && pair < heap_[(i - 1) / 4]) {
            heap_[i] = heap_[(i - 1) / 4];
            i = (i - 1) / 4;
        }
        heap_[i] = pair;
    }
    void sift_down(std::size_t i, const QueuedPair pair) {
        for (;;) {
            const std::size_t first = 4 * i + 1, last = std::min(first + 4, heap_.size());
            if (first >= last) break;
            std::size_t least = first;
            for (std::size_t c = first + 1; c < last; ++c)
                least = heap_[c] < heap_[least] ? c : least;
            if (!(heap_[least] < pair)) break;
            heap_[i] = heap_[least];
            i = least;
        }
        heap_[i] = pair;
    }

    std::size_t buckets_;
    float scale_;                   // buckets by cost
    std::vector<QueuedPair> heap_;  // of all buckets up to open_
    std::size_t open_ = 0;
    std::vector<Chunk> chunks_;
    std::vector<std::uint32_t> first_chunk_;  // by bucket
    std::vector<std::uint64_t> occupied_;     // a bit a bucket
    std::uint32_t free_chunk_ = kNone;
};

}  // namespace splice
