#include "engine/scene/surfel_pager.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <latch>
#include <numeric>
#include <random>
#include <stdexcept>

using namespace splice;

namespace {

constexpr std::uint64_t kBlock = SurfelPager::kBlockBytes;

std::vector<std::byte> numbered_bytes(std::uint64_t count) {
    std::vector<std::byte> bytes(count);
    for (std::uint64_t i = 0; i < count; ++i)
        bytes[i] = static_cast<std::byte>((i * 2654435761u) >> 13);
    return bytes;
}

SurfelPager::Read from(const std::vector<std::byte>& source) {
    return [&source](std::uint64_t first, std::span<std::byte> bytes) {
        std::memcpy(bytes.data(), source.data() + first, bytes.size());
    };
}

}  // namespace

TEST_CASE("a pager has what was wanted, and no more than its limit") {
    const std::vector<std::byte> source = numbered_bytes(10 * kBlock + 1000);
    SurfelPager pager(source.size(), 4 * kBlock + 5, from(source));
    CHECK(pager.blocks() == 11);
    CHECK(pager.capacity() == 4);
    std::mt19937 random(1);
    std::vector<std::uint32_t> all(pager.blocks());
    std::iota(all.begin(), all.end(), 0u);
    for (int i = 0; i < 200; ++i) {
        std::shuffle(all.begin(), all.end(), random);
        const std::vector<std::uint32_t> wanted(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(random() % 7));
        pager.want(wanted);
        if (i % 2 == 0) pager.wait();
        std::size_t wrong = 0;
        for (std::size_t w = 0; w < wanted.size(); ++w) {
            const auto block = pager.find(wanted[w]);
            wrong += i % 2 == 0 && block.empty() != (w >= 4);
            const std::uint64_t first = wanted[w] * kBlock;
            if (!block.empty())
                wrong += std::memcmp(block.data(), source.data() + first, block.size()) != 0 ||
                         block.size() != std::min(kBlock, source.size() - first);
        }
        CHECK(wrong == 0);
        CHECK(pager.resident_bytes() <= 4 * kBlock);
    }
    CHECK(pager.blocks_read() > 100);
}

TEST_CASE("what stays wanted is not read again, and a limit below one block is one block") {
    const std::vector<std::byte> source = numbered_bytes(3 * kBlock);
    SurfelPager pager(source.size(), 1, from(source));
    for (int i = 0; i < 5; ++i) {
        pager.want({2});
        pager.wait();
        CHECK(pager.find(2).size() == kBlock);
    }
    CHECK(pager.blocks_read() == 1);
    CHECK(pager.resident_bytes() == kBlock);
}

TEST_CASE("a pager that cannot read tells who waits") {
    SurfelPager pager(kBlock, kBlock, [](std::uint64_t, std::span<std::byte>) { throw std::runtime_error("gone"); });
    pager.want({0});
    CHECK_THROWS_WITH(pager.wait(), "gone");
    CHECK(pager.find(0).empty());
}

TEST_CASE("nobody who does not wait is held up by reading") {
    std::latch released(1);
    const std::vector<std::byte> source = numbered_bytes(2 * kBlock);
    SurfelPager pager(source.size(), 2 * kBlock, [&](std::uint64_t first, std::span<std::byte> bytes) {
        released.wait();
        from(source)(first, bytes);
    });
    pager.want({0, 1});
    CHECK(pager.find(0).empty());
    pager.want({1});
    CHECK(pager.find(1).empty());
    released.count_down();
    pager.wait();
    CHECK(pager.find(1).size() == kBlock);
}
