#include "preprocess/model_format/checksum.h"

#include <bit>
#include <cstring>

namespace splice {
namespace {

static_assert(std::endian::native == std::endian::little, "model files are little-endian and used as they lie");

constexpr std::uint64_t kPrime = 0x00000100000001b3u;

std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
    return (state ^ word) * kPrime;
}

}  // namespace

void Checksum::add(std::span<const std::byte> piece) {
    const std::size_t whole = piece.size() / 8 * 8;
    std::uint64_t state = state_;
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < whole; i += 8) {
        std::memcpy(&word, piece.data() + i, 8);
        state = mix(state, word);
    }
    if (whole != piece.size()) {
        word = 0;
        std::memcpy(&word, piece.data() + whole, piece.size() - whole);
        state = mix(state, word);
    }
    state_ = state;
    length_ += piece.size();
}

std::uint64_t Checksum::value() const {
    return mix(state_, length_);
}

}  // namespace splice
