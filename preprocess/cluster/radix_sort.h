// Sorting numbered keys without comparing them: a few linear passes, several times faster than a comparison sort of the
// few hundred thousand keys that a mesh has.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace splice {

/// Sorts `entries` by their high 32 bits; those with equal high halves keep their order.
inline void radix_sort_by_high_half(std::vector<std::uint64_t>& entries) {
    constexpr std::size_t kBits = 11, kPasses = 3, kDigits = std::size_t{1} << kBits;
    const auto digit = [](std::uint64_t entry, std::size_t pass) {
        return static_cast<std::size_t>(entry >> (32 + pass * kBits)) % kDigits;
    };
    std::vector<std::array<std::size_t, kDigits>> begin(kPasses);
    for (auto& counts : begin)
        counts.fill(0);
    for (const std::uint64_t entry : entries) {
        for (std::size_t pass = 0; pass < kPasses; ++pass)
            ++begin[pass][digit(entry, pass)];
    }
    std::vector<std::uint64_t> sorted(entries.size());
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
        // The same digit everywhere, as the highest of small keys is: nothing to sort.
        if (!entries.empty() && begin[pass][digit(entries[0], pass)] == entries.size()) continue;
        std::size_t sum = 0;
        for (std::size_t& b : begin[pass])
            sum += std::exchange(b, sum);
        for (const std::uint64_t entry : entries)
            sorted[begin[pass][digit(entry, pass)]++] = entry;
        entries.swap(sorted);
    }
}

}  // namespace splice
