#include "preprocess/mesh/weld_vertices.h"

#include <bit>

namespace splice {
namespace {

std::uint64_t hash_position(const Vec3f& p) {
    // Adding zero turns -0 into +0. The finaliser is that of SplitMix64 (Steele, Lea and Flood 2014).
    std::uint64_t h = 0;
    for (const float coordinate : {p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f}) {
        h = (h ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9e3779b97f4a7c15ull;
        h ^= h >> 32;
    }
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
}

}  // namespace

Weld weld_positions(std::span<const Vec3f> positions) {
    constexpr std::uint32_t kEmpty = 0xffffffffu;
    const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kEmpty);
    Weld weld;
    weld.representative.resize(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = hash_position(positions[i]) & (slots - 1);
        while (table[slot] != kEmpty && positions[table[slot]] != positions[i])
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == kEmpty) {
            table[slot] = i;
        } else {
            ++weld.merged;
        }
        weld.representative[i] = table[slot];
    }
    return weld;
}

}  // namespace splice
