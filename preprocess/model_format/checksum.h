// The checksum of a model file: 64-bit FNV-1a (Fowler, Noll and Vo) over 8-byte little-endian words instead of bytes,
// which is eight times faster. The tail is padded with zeros to a whole word and the length in bytes is mixed in last,
// so that files that differ in trailing zeros differ. A change of any single word always changes the result (each step
// is a bijection). It detects damage; it is no protection against forgery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace splice {

class Checksum {
  public:
    /// Every piece but the last must be a multiple of 8 bytes long.
    void add(std::span<const std::byte> piece);
    std::uint64_t value() const;

  private:
    static constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325u;
    std::uint64_t state_ = kOffsetBasis;
    std::uint64_t length_ = 0;
};

}  // namespace splice
