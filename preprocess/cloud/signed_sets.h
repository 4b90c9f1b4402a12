// Union-find over elements that have a sign relative to their set's representative.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace splice {

class SignedSets {
  public:
    explicit SignedSets(std::size_t elements) : parent_(elements), opposite_(elements, 0) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    struct Place {
        std::uint32_t representative;
        bool opposite;  // to the representative
    };

    Place find(std::uint32_t element) {
        bool opposite = false;
        while (parent_[element] != element) {
            // Halve the path: each element on it moves to its grandparent.
            const std::uint32_t above = parent_[element];
            opposite_[element] = opposite_[element] != opposite_[above];
            parent_[element] = parent_[above];
            opposite = opposite != (opposite_[element] != 0);
            element = parent_[element];
        }
        return {element, opposite};
    }

    bool are_joined(std::uint32_t a, std::uint32_t b) {
        return parent_[a] == parent_[b] || find(a).representative == find(b).representative;
    }

    /// Joins the sets of `a` and `b` so that both have equal or opposite signs. False if they were one set already. The
    /// smaller representative stays.
    bool join(std::uint32_t a, std::uint32_t b, bool opposite) {
        const Place of_a = find(a), of_b = find(b);
        if (of_a.representative == of_b.representative) return false;
        const bool relative = opposite != (of_a.opposite != of_b.opposite);
        const bool a_stays = of_a.representative < of_b.representative;
        const std::uint32_t stays = a_stays ? of_a.representative : of_b.representative;
        const std::uint32_t goes = a_stays ? of_b.representative : of_a.representative;
        parent_[goes] = stays;
        opposite_[goes] = relative;
        return true;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> opposite_;  // to the parent
};

}  // namespace splice
