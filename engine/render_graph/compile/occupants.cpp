#include "engine/render_graph/compile/occupants.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace splice::graph {
namespace {

/// Who holds which bytes of a heap.
class Occupation {
  public:
    explicit Occupation(uint64_t size) : pieces_{{0, none}, {size, none}} {}

    /// Calls visit(begin, end, holder) for the pieces that [begin, end) is made of.
    template <typename Visit>
    void visit(uint64_t begin, uint64_t end, const Visit& visit_piece) const {
        for (size_t piece = piece_at(begin); pieces_[piece].begin < end; ++piece) {
            visit_piece(std::max(begin, pieces_[piece].begin), std::min(end, pieces_[piece + 1].begin),
                        pieces_[piece].holder);
        }
    }

    /// Visits what [begin, end) is made of and hands it to `holder`.
    template <typename Visit>
    void take(uint64_t begin, uint64_t end, uint32_t holder, const Visit& visit_piece) {
        const size_t first = piece_at(begin);
        size_t last = first;  // the piece that holds the last byte
        for (;; ++last) {
            const uint64_t piece_end = pieces_[last + 1].begin;
            visit_piece(std::max(begin, pieces_[last].begin), std::min(end, piece_end), pieces_[last].holder);
            if (end <= piece_end) break;
        }
        // Up to three pieces take the place of first .. last.
        Piece replacement[3];
        size_t count = 0;
        if (pieces_[first].begin < begin) replacement[count++] = pieces_[first];
        replacement[count++] = {begin, holder};
        if (end < pieces_[last + 1].begin) replacement[count++] = {end, pieces_[last].holder};
        const size_t old_count = last - first + 1;
        const auto at = pieces_.begin() + static_cast<std::ptrdiff_t>(first);
        if (count < old_count) {
            pieces_.erase(at, at + static_cast<std::ptrdiff_t>(old_count - count));
        } else if (count > old_count) {
            pieces_.insert(at, count - old_count, {});
        }
        std::copy(replacement, replacement + count, pieces_.begin() + static_cast<std::ptrdiff_t>(first));
    }

  private:
    struct Piece {
        uint64_t begin = 0;  // ends where the next begins
        uint32_t holder = none;
    };
    size_t piece_at(uint64_t byte) const {
        const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), byte,
                                           [](uint64_t at, const Piece& piece) { return at < piece.begin; });
        return static_cast<size_t>(next - pieces_.begin()) - 1;
    }
    std::vector<Piece> pieces_;
};

/// `before` had bytes of `item` last.
struct Succession {
    uint32_t item, before;
};

/// The items of a heap play a frame; those that had bytes first in it learn who had them last.
class Replay {
  public:
    explicit Replay(std::span<const PackItem> items) : items_(items), heap_(end_of(items)) {
        found_.reserve(2 * items.size());
    }

    std::vector<Succession> run(uint32_t moments) {
        for (const uint32_t item : by_birth(moments)) {
            if (items_[item].slot == none) {
                take_bytes(item);
            } else {
                take_slot(item);
            }
        }
        for (const Unclaimed& bytes : unclaimed_) {
            heap_.visit(bytes.begin, bytes.end, [&](uint64_t, uint64_t, uint32_t holder) {
                found_.push_back({bytes.item, holder});
            });
        }
        for (const uint32_t item : first_in_slot_)
            found_.push_back({item, slots_[items_[item].slot]});
        return std::move(found_);
    }

  private:
    /// Bytes that nobody had before in the frame.
    struct Unclaimed {
        uint32_t item;
        uint64_t begin, end;
    };

    static uint64_t end_of(std::span<const PackItem> items) {
        uint64_t end = 0;
        for (const PackItem& item : items)
            end = std::max(end, item.offset + item.size);
        return end;
    }

    std::vector<uint32_t> by_birth(uint32_t moments) const {
        std::vector<uint32_t> starts(size_t{moments} + 1, 0), order(items_.size());
        for (const PackItem& item : items_)
            ++starts[item.first + 1];
        std::partial_sum(starts.begin(), starts.end(), starts.begin());
        for (uint32_t item = 0; item < items_.size(); ++item)
            order[starts[items_[item].first]++] = item;
        return order;
    }

    void take_bytes(uint32_t item) {
        const uint64_t begin = items_[item].offset, end = begin + items_[item].size;
        heap_.take(begin, end, item, [&](uint64_t from, uint64_t to, uint32_t holder) {
            if (holder == none) {
                unclaimed_.push_back({item, from, to});
            } else {
                found_.push_back({item, holder});
            }
        });
    }

    void take_slot(uint32_t item) {
        const uint32_t slot = items_[item].slot;
        if (slot >= slots_.size()) slots_.resize(slot + 1, none);
        if (slots_[slot] == none) {
            first_in_slot_.push_back(item);
        } else {
            found_.push_back({item, slots_[slot]});
        }
        slots_[slot] = item;
    }

    std::span<const PackItem> items_;
    Occupation heap_;
    std::vector<uint32_t> slots_;  // who holds each
    std::vector<Unclaimed> unclaimed_;
    std::vector<uint32_t> first_in_slot_;
    std::vector<Succession> found_;
};

}  // namespace

void find_occupants(std::span<const PackItem> items, std::span<const uint32_t> resources, Compilation& compilation) {
    const std::vector<Succession> found = Replay(items).run(static_cast<uint32_t>(compilation.plan.groups.size()));
    std::pmr::vector<Range>& before = compilation.occupants_before;
    for (const Succession& pair : found)
        ++before[resources[pair.item]].count;
    auto first = static_cast<uint32_t>(compilation.occupants.size());
    for (const uint32_t resource : resources) {
        before[resource].first = first;
        first += std::exchange(before[resource].count, 0);
    }
    compilation.occupants.resize(first);
    for (const Succession& pair : found) {
        Range& range = before[resources[pair.item]];
        compilation.occupants[range.first + range.count++] = resources[pair.before];
    }
}

}  // namespace splice::graph
