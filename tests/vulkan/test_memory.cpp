// The block allocator and the cutting of storage buffers.
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/memory.h"
#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace splice;

TEST_CASE("allocations of a block never overlap, respect alignment and are reused after release") {
    const gpu::Instance instance;
    gpu::Device device(instance);
    gpu::MemoryAllocator allocator(device.physical(), device.handle(), 1 << 16);
    std::vector<gpu::Memory> alive;
    uint32_t state = 1;
    for (int round = 0; round < 2000; ++round) {
        state = state * 1664525U + 1013904223U;
        const VkDeviceSize size = 1 + (state >> 8) % 4000, alignment = VkDeviceSize{1} << (state >> 28);
        if (round % 3 == 2) {
            alive.erase(alive.begin() + static_cast<std::ptrdiff_t>((state >> 4) % alive.size()));
        } else {
            alive.push_back(allocator.allocate({size, alignment, ~0U}, gpu::MemoryUse::device, false));
            CHECK(alive.back().offset() % alignment == 0);
        }
    }
    std::sort(alive.begin(), alive.end(), [](const gpu::Memory& a, const gpu::Memory& b) {
        return a.handle() != b.handle() ? a.handle() < b.handle() : a.offset() < b.offset();
    });
    VkDeviceSize total = 0;
    for (size_t i = 0; i < alive.size(); ++i) {
        total += alive[i].size();
        if (i > 0 && alive[i].handle() == alive[i - 1].handle()) {
            CHECK(alive[i - 1].offset() + alive[i - 1].size() <= alive[i].offset());
        }
    }
    CHECK(allocator.statistics().allocated_bytes == total);
    const uint64_t blocks = allocator.statistics().blocks;
    alive.clear();
    CHECK(allocator.statistics().allocated_bytes == 0);
    // All holes have grown together again: a block takes an allocation of half its size.
    for (uint64_t i = 0; i < blocks; ++i) {
        alive.push_back(allocator.allocate({1 << 15, 1, ~0U}, gpu::MemoryUse::device, false));
    }
    CHECK(allocator.statistics().blocks == blocks);
}

TEST_CASE("large allocations get a block of their own, which goes with them, images and buffers never share one") {
    const gpu::Instance instance;
    gpu::Device device(instance);
    gpu::MemoryAllocator allocator(device.physical(), device.handle(), 1 << 16);
    {
        const gpu::Memory large = allocator.allocate({1 << 17, 1, ~0U}, gpu::MemoryUse::device, false);
        CHECK(allocator.statistics().blocks == 1);
    }
    CHECK(allocator.statistics().blocks == 0);
    const gpu::Memory buffer = allocator.allocate({64, 1, ~0U}, gpu::MemoryUse::device, false);
    const gpu::Memory image = allocator.allocate({64, 1, ~0U}, gpu::MemoryUse::device, true);
    CHECK(buffer.handle() != image.handle());
    CHECK_THROWS_AS(allocator.allocate({~VkDeviceSize{0} / 2, 1, ~0U}, gpu::MemoryUse::device, false), DeviceError);
}

TEST_CASE("storage chunks cover every element once within the limits of a descriptor") {
    VkPhysicalDeviceLimits limits{};
    limits.maxStorageBufferRange = 1000;
    limits.minStorageBufferOffsetAlignment = 16;
    for (const uint64_t element : {4U, 12U, 20U, 32U}) {
        for (const uint64_t elements : {0U, 1U, 49U, 50U, 51U, 1000U}) {
            const std::vector<gpu::StorageChunk> chunks = gpu::storage_chunks(limits, elements, element);
            uint64_t next = 0;
            for (const gpu::StorageChunk& chunk : chunks) {
                CHECK(chunk.first_element == next);
                CHECK(chunk.offset == next * element);
                CHECK(chunk.offset % 16 == 0);
                CHECK(chunk.size == chunk.elements * element);
                CHECK(chunk.size <= 1000);
                next += chunk.elements;
            }
            CHECK(next == elements);
        }
    }
    CHECK(gpu::storage_chunks(limits, 0, 16).size() == 1);
    CHECK_THROWS_AS(gpu::storage_chunks(limits, 1, 2000), DeviceError);
    CHECK_THROWS_AS(gpu::storage_chunks(limits, 1, 0), DeviceError);
    limits.maxStorageBufferRange = 1U << 27;  // as lavapipe has it
    CHECK(gpu::storage_chunks(limits, (uint64_t{1} << 27) / 32 + 1, 32).size() == 2);
}
