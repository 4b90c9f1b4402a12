#include "engine/render_graph/packing/lifetime_index.h"

#include <algorithm>
#include <bit>

namespace splice::graph {
namespace {

constexpr uint32_t kShift = 4;  // the shortest buckets are 16 moments wide
constexpr size_t kMostGathered = 512;

}  // namespace

uint32_t LifetimeIndex::level_of(const PackItem& item) {
    return static_cast<uint32_t>(std::bit_width((item.last - item.first) >> kShift));
}

LifetimeIndex::LifetimeIndex(std::span<const PackItem> items, uint32_t moments)
    : items_(items), tops_((moments >> kShift) + 1, 0) {
    for (const PackItem& item : items) {
        const uint32_t level = level_of(item);
        if (level >= levels_.size()) levels_.resize(level + 1);
        ++levels_[level].entries;
    }
    uint32_t buckets = 0;
    for (uint32_t level = 0; level < levels_.size(); ++level) {
        levels_[level].shift = kShift + level;
        levels_[level].first_bucket = buckets;
        buckets += (moments >> levels_[level].shift) + 1;
    }
    starts_.assign(size_t{buckets} + 1, 0);
    for (const PackItem& item : items) {
        const Level& level = levels_[level_of(item)];
        ++starts_[level.first_bucket + (item.first >> level.shift) + 1];
    }
    for (size_t bucket = 0; bucket < buckets; ++bucket)
        starts_[bucket + 1] += starts_[bucket];
    ends_.resize(buckets);
    entries_.resize(items.size());
    clear();
}

void LifetimeIndex::clear() {
    std::copy(starts_.begin(), starts_.end() - 1, ends_.begin());
    std::fill(tops_.begin(), tops_.end(), 0);
    height_ = total_ = 0;
    latest_first_ = 0;
    earliest_last_ = UINT32_MAX;
}

void LifetimeIndex::add(uint32_t index, uint64_t offset) {
    const PackItem& item = items_[index];
    const uint64_t end = offset + item.size;
    const Level& level = levels_[level_of(item)];
    entries_[ends_[level.first_bucket + (item.first >> level.shift)]++] = {item.first, item.last, offset, end};
    for (uint32_t block = item.first >> kShift; block <= item.last >> kShift; ++block)
        tops_[block] = std::max(tops_[block], end);
    height_ = std::max(height_, end);
    total_ += item.size;
    latest_first_ = std::max(latest_first_, item.first);
    earliest_last_ = std::min(earliest_last_, item.last);
}

/// Which entries live with the item is as good as random: all are copied, and those that do are kept, without a branch.
bool LifetimeIndex::gather(const PackItem& item) {
    size_t count = 0;
    for (const Level& level : levels_) {
        if (level.entries == 0) continue;
        const uint32_t earlier = (item.first >> level.shift) > 0 ? (item.first >> level.shift) - 1 : 0;
        for (uint32_t bucket = earlier; bucket <= item.last >> level.shift; ++bucket) {
            const uint32_t begin = starts_[level.first_bucket + bucket], end = ends_[level.first_bucket + bucket];
            gathered_.resize(std::max(gathered_.size(), count + (end - begin)));
            for (uint32_t i = begin; i < end; ++i) {
                const Entry& entry = entries_[i];
                gathered_[count] = {entry.begin, entry.end};
                count += (entry.first <= item.last) & (item.first <= entry.last);
            }
            if (count > kMostGathered) return false;
        }
    }
    gathered_count_ = count;
    return true;
}

uint64_t LifetimeIndex::above_all(const PackItem& item) const {
    uint64_t top = 0;
    for (uint32_t block = item.first >> kShift; block <= item.last >> kShift; ++block)
        top = std::max(top, tops_[block]);
    return align_up(top, item.alignment);
}

uint64_t LifetimeIndex::lowest_free(const PackItem& item) {
    // All live with it, and there is no gap between them.
    if (height_ == total_ && latest_first_ <= item.last && item.first <= earliest_last_) {
        return align_up(height_, item.alignment);
    }
    if (!gather(item)) return above_all(item);
    const std::span<Bytes> taken(gathered_.data(), gathered_count_);
    std::sort(taken.begin(), taken.end(), [](const Bytes& a, const Bytes& b) { return a.begin < b.begin; });
    uint64_t offset = 0;
    for (const Bytes& bytes : taken) {
        if (offset + item.size <= bytes.begin) break;
        offset = std::max(offset, align_up(bytes.end, item.alignment));
    }
    return offset;
}

}  // namespace splice::graph
