// How much of a model's surfels may be held in memory, and where the others are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace splice {

struct Paging {
    std::uint64_t limit = ~std::uint64_t{0};  // bytes
    std::shared_ptr<const void> owner = {};   // keeps the view's memory; without one, nothing is paged
    /// Says that nobody reads these bytes of the view soon. Called by any thread.
    std::function<void(std::span<const std::byte>)> release = {};
};

/// Of a frame, over all models that are paged.
struct PageStats {
    std::uint64_t limit_bytes = 0;      // 0: no model is paged
    std::uint64_t resident_bytes = 0;   // of surfels; those of models that are not paged are not counted
    std::uint64_t blocks_read = 0;      // since the models were loaded
    std::uint64_t missing_surfels = 0;  // of the cut; nodes of the point tree were drawn in their place
};

}  // namespace splice
