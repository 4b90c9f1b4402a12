// Data goes to the device and comes back unchanged, with and without staging.
#include "engine/vulkan/device.h"
#include "engine/vulkan/transfer.h"
#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

#include <vector>

namespace {

using namespace splice;

std::vector<std::byte> pattern(size_t size) {
    std::vector<std::byte> bytes(size);
    uint32_t state = 7;
    for (std::byte& byte : bytes) {
        state = state * 1664525U + 1013904223U;
        byte = static_cast<std::byte>(state >> 24);
    }
    return bytes;
}

}  // namespace

TEST_CASE("a buffer holds what was uploaded, mapped or staged in pieces") {
    const gpu::Instance instance({.application = "splice tests", .validate = true});
    const bool staged = GENERATE(false, true);
    gpu::Device device(instance, {.choice = {}, .force_staging = staged});
    const std::vector<std::byte> bytes = pattern((size_t{33} << 20) + 12);  // more than one staging piece
    gpu::Buffer buffer = gpu::create_buffer(device, {0, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}, bytes);
    CHECK((gpu::read_back(device, buffer, 0, bytes.size()) == bytes));
    const std::vector<std::byte> patch = pattern(8);
    gpu::upload(device, buffer, patch, 100);
    CHECK((gpu::read_back(device, buffer, 100, 8) == patch));
    CHECK_THROWS_AS(gpu::upload(device, buffer, bytes, 4), DeviceError);
    CHECK_THROWS_AS(gpu::read_back(device, buffer, UINT64_MAX, 8), DeviceError);
    CHECK(instance.messages().empty());
}

TEST_CASE("an image holds what was uploaded") {
    const gpu::Instance instance({.application = "splice tests", .validate = true});
    gpu::Device device(instance);
    gpu::ImageOptions options;
    options.format = VK_FORMAT_R8G8B8A8_UNORM;
    options.width = 37;
    options.height = 11;
    options.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const gpu::Image image(device, options);
    const std::vector<std::byte> bytes = pattern(size_t{37} * 11 * 4);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {37, 11, 1};
    gpu::upload(device, image, bytes, std::span(&region, 1));
    CHECK((gpu::read_back(device, image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) == bytes));
    CHECK(instance.messages().empty());
}

TEST_CASE("an image beyond the device's limits is refused with its size") {
    const gpu::Instance instance;
    gpu::Device device(instance);
    gpu::ImageOptions options;
    options.format = VK_FORMAT_R8G8B8A8_UNORM;
    options.width = 1U << 30;
    options.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    options.name = "poster";
    CHECK_THROWS_WITH(gpu::Image(device, options), Catch::Contains("'poster'") && Catch::Contains("1073741824 x 1"));
}
