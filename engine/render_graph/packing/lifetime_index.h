// Which of the items that are placed already live together with a new one: by level of lifetime length and by time.
#pragma once

#include "engine/render_graph/packing/pack.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

/// Items whose lives are at most 16 * 2^k moments long are kept in buckets of that width, by their first moment, so a
/// search visits few buckets besides those with items that it wants.
class LifetimeIndex {
  public:
    LifetimeIndex(std::span<const PackItem> items, uint32_t moments);

    void clear();
    void add(uint32_t item, uint64_t offset);
    /// The lowest offset that is free for the life of the item. Where very many items live with it, an offset above
    /// all of them, so that the time stays in bounds.
    uint64_t lowest_free(const PackItem& item);
    /// Where the highest of the items ends.
    uint64_t height() const { return height_; }

  private:
    struct Entry {
        uint32_t first, last;
        uint64_t begin, end;
    };
    struct Bytes {
        uint64_t begin, end;
    };
    struct Level {
        uint32_t shift = 0;         // buckets are 2^shift moments wide
        uint32_t first_bucket = 0;  // into starts_ and ends_
        uint32_t entries = 0;
    };
    static uint32_t level_of(const PackItem& item);
    bool gather(const PackItem& item);
    uint64_t above_all(const PackItem& item) const;

    std::span<const PackItem> items_;
    std::vector<Level> levels_;
    std::vector<uint32_t> starts_, ends_;  // one a bucket: its entries
    std::vector<Entry> entries_;
    std::vector<Bytes> gathered_;  // the first gathered_count_ live with the item in question
    size_t gathered_count_ = 0;
    std::vector<uint64_t> tops_;  // the highest byte in use in each 16 moments
    // Of all items added: whether they form one stack without gaps, and a moment that is in the life of each.
    uint64_t height_ = 0, total_ = 0;
    uint32_t latest_first_ = 0, earliest_last_ = UINT32_MAX;
};

}  // namespace splice::graph
