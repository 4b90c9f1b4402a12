#include "preprocess/model_format/checksum.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <string>
#include <vector>

using splice::Checksum;

namespace {

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
    Checksum checksum;
    checksum.add(bytes);
    return checksum.value();
}

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

// The definition, a word at a time.
std::uint64_t by_definition(const std::string& text) {
    std::uint64_t state = 14695981039346656037u;
    for (std::size_t i = 0; i < text.size(); i += 8) {
        std::uint64_t word = 0;
        for (std::size_t k = 0; k < 8 && i + k < text.size(); ++k)
            word |= std::uint64_t{static_cast<unsigned char>(text[i + k])} << (8 * k);
        state = (state ^ word) * 1099511628211u;
    }
    return (state ^ text.size()) * 1099511628211u;
}

}  // namespace

TEST_CASE("checksum is FNV-1a over little-endian words and the length") {
    for (const std::string text :
         {"", "a", "splice", "eight by", "sixteen bytes ..", "some text that ends inside a word"})
        CHECK(checksum_of(bytes_of(text)) == by_definition(text));
}

TEST_CASE("checksum of pieces is that of the whole") {
    const std::string text = "0123456789abcdefghijklmnopqrstuvwxyz";
    for (std::size_t cut = 0; cut <= text.size(); cut += 8) {
        Checksum checksum;
        checksum.add(bytes_of(text).first(cut));
        checksum.add(bytes_of(text).subspan(cut));
        CHECK(checksum.value() == checksum_of(bytes_of(text)));
    }
}

TEST_CASE("checksum tells trailing zeros and every single bit apart") {
    std::vector<std::byte> bytes(40);
    const std::uint64_t original = checksum_of(bytes);
    CHECK(checksum_of(std::span(bytes).first(39)) != original);
    CHECK(checksum_of(std::span(bytes).first(32)) != original);
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        CHECK(checksum_of(bytes) != original);
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
}
