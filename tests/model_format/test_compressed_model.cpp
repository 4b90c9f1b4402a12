// Compressed model files: the same model back, and no damage or lie that gets through or asks for memory.
#include "preprocess/model_format/checksum.h"
#include "preprocess/model_format/compressed_model.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/section_layout.h"
#include "tests/model_format/small_model.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <functional>
#include <random>

using namespace splice;
using namespace splice::format;
using Catch::Matchers::Contains;

namespace {

std::vector<std::byte> plain_bytes() {
    return serialise_model(view_of(test::small_model()));
}

void forge_checksum(std::vector<std::byte>& bytes) {
    FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    header.file_bytes = bytes.size();
    header.checksum = 0;
    std::memcpy(bytes.data(), &header, sizeof header);
    Checksum checksum;
    checksum.add(bytes);
    header.checksum = checksum.value();
    std::memcpy(bytes.data(), &header, sizeof header);
}

std::string refusal(const std::vector<std::byte>& bytes) {
    try {
        const std::vector<std::byte> plain = expand_model(bytes, "m.splice");
        parse_model(plain, "m.splice");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string refusal_of_entry(std::size_t index, const std::function<void(SectionEntry&)>& change) {
    std::vector<std::byte> bytes = compress_model(plain_bytes());
    std::byte* const place = bytes.data() + sizeof(FileHeader) + index * sizeof(SectionEntry);
    SectionEntry entry;
    std::memcpy(&entry, place, sizeof entry);
    change(entry);
    std::memcpy(place, &entry, sizeof entry);
    forge_checksum(bytes);
    return refusal(bytes);
}

// Of the first section that is compressed.
std::size_t compressed_section() {
    const std::vector<std::byte> bytes = compress_model(plain_bytes());
    for (std::size_t i = 0; i < kSectionCount; ++i) {
        SectionEntry entry;
        std::memcpy(&entry, bytes.data() + sizeof(FileHeader) + i * sizeof(SectionEntry), sizeof entry);
        if (entry.reserved != 0) return i;
    }
    FAIL("no section is compressed");
    return 0;
}

}  // namespace

TEST_CASE("a compressed model expands to the bytes it was made of") {
    if (!can_compress_models()) return;
    const std::vector<std::byte> plain = plain_bytes(), compressed = compress_model(plain);
    CHECK(compressed.size() < plain.size());
    CHECK(is_compressed_model(compressed));
    CHECK_FALSE(is_compressed_model(plain));
    CHECK(expand_model(compressed, "m.splice") == plain);
    CHECK(compress_model(plain) == compressed);
}

TEST_CASE("a compressed model file is read like a plain one") {
    if (!can_compress_models()) return;
    const test::TemporaryFolder folder;
    const Model model = test::small_model();
    const std::uint64_t size = write_compressed_model(view_of(model), folder / "m.splice");
    CHECK(size == std::filesystem::file_size(folder / "m.splice"));
    ModelFile file(folder / "m.splice");
    CHECK(file.is_compressed());
    CHECK(file.bytes().size() == size);
    const auto bytes_of = [](const ModelView& view) { return serialise_model(view); };
    CHECK(bytes_of(file.view()) == bytes_of(view_of(model)));
    // Of a mapped file this gives pages back; of an expanded one it must not.
    file.release(std::as_bytes(file.view().surfels));
    const ModelFile moved = std::move(file);
    CHECK(bytes_of(moved.view()) == bytes_of(view_of(model)));
}

TEST_CASE("a compressed file cut anywhere or with a flipped bit is refused") {
    if (!can_compress_models()) return;
    std::vector<std::byte> bytes = compress_model(plain_bytes());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        if (refusal(cut) == "accepted") FAIL("cut to " << size);
    }
    for (std::size_t bit = 0; bit < bytes.size() * 8; bit += 3) {
        bytes[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        if (refusal(bytes) == "accepted") FAIL("bit " << bit);
        bytes[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    }
}

TEST_CASE("a compressed file's sizes are not believed") {
    if (!can_compress_models()) return;
    const std::size_t section = compressed_section();
    const auto after = [&](auto change) { return refusal_of_entry(section, change); };
    CHECK_THAT(after([](SectionEntry& e) { e.count = ~0ull; }), Contains("do not fit"));
    CHECK_THAT(after([](SectionEntry& e) { e.count = ~0ull / e.stride; }), Contains("do not fit"));
    CHECK_THAT(after([](SectionEntry& e) { e.count = e.reserved * kMostExpansion / e.stride + 1; }),
               Contains("do not fit"));
    CHECK_THAT(after([](SectionEntry& e) { e.count += 1; }), Contains("as the table says"));
    CHECK_THAT(after([](SectionEntry& e) { e.stride = 0; }), Contains("do not fit"));
    CHECK_THAT(after([](SectionEntry& e) { e.reserved = ~0ull; }), Contains("leave the file"));
    CHECK_THAT(after([](SectionEntry& e) { e.reserved -= 1; }), Contains("byte"));
    CHECK_THAT(after([](SectionEntry& e) { e.offset += 64; }), Contains("behind the one before"));
}

TEST_CASE("random damage to a compressed file under a forged checksum never crashes the reader") {
    if (!can_compress_models()) return;
    const std::vector<std::byte> original = compress_model(plain_bytes());
    std::mt19937 random(9);
    std::size_t refused = 0;
    constexpr std::size_t kRounds = 20000;
    for (std::size_t round = 0; round < kRounds; ++round) {
        std::vector<std::byte> bytes = original;
        for (int changes = 1 + static_cast<int>(random() % 3); changes > 0; --changes)
            bytes[12 + random() % (bytes.size() - 12)] = static_cast<std::byte>(random());
        forge_checksum(bytes);
        refused += refusal(bytes) != "accepted";
    }
    CHECK(refused > kRounds / 2);
}
