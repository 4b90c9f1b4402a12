// Stands for a declaration in a cache of plans: kept up while a frame is declared, so that finding the plan of an
// unchanged frame reads a few words instead of two declarations. Two different declarations have the same key with a
// probability of about 2^-128 a pair; debug builds check.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace splice::graph {

/// Two independent multiplicative hashes of a sequence of words, with the finaliser of SplitMix64 (Steele, Lea and
/// Flood 2014) on each word.
class SequenceDigest {
  public:
    void add(uint64_t word) {
        word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
        word ^= word >> 27;
        first_ = (first_ + word) * 0x94d049bb133111ebu;
        second_ = ((second_ << 29 | second_ >> 35) ^ word) * 0x9e3779b97f4a7c15u;
    }
    /// All bytes of a value without padding.
    template <typename T>
    void add_bytes(const T& value) {
        static_assert(std::has_unique_object_representations_v<T>);
        uint64_t words[(sizeof(T) + 7) / 8] = {};
        std::memcpy(words, &value, sizeof(T));
        for (const uint64_t word : words)
            add(word);
    }
    friend bool operator==(const SequenceDigest&, const SequenceDigest&) = default;

  private:
    uint64_t first_ = 0x6a09e667f3bcc908u, second_ = 0xbb67ae8584caa73bu;
};

/// A sequence each, so that no record of one kind can stand for records of another: what is declared can be read back
/// from the words that are added. A resource is followed by its import if it says that it has one; a pass says where
/// its accesses begin.
struct DeclarationKey {
    SequenceDigest resources, passes, accesses, side_effects;
    friend bool operator==(const DeclarationKey&, const DeclarationKey&) = default;
};

}  // namespace splice::graph
