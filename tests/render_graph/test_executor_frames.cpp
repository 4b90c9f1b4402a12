// The four-subpass frame on a device, with validation and synchronisation validation.
#include "tests/render_graph/device_fixture.h"
#include "tests/render_graph/surfel_frame.h"

#include <catch2/catch.hpp>
#include <vulkan/vulkan_core.h>

#include <array>
#include <memory>
#include <vector>

namespace {

using namespace splice;

std::array<int, 4> pixel(const std::vector<uint8_t>& image, uint32_t width, uint32_t x, uint32_t y) {
    const size_t at = (size_t{y} * width + x) * 4;
    return {image[at], image[at + 1], image[at + 2], image[at + 3]};
}

constexpr std::array<int, 4> kSurfels{170, 0, 85, 153}, kTriangles{51, 102, 153, 102};

}  // namespace

TEST_CASE("the frame of four passes is one render pass and draws what it should") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    test::SurfelFrame frame(gpu.device, 64, 48);
    const std::vector<uint8_t> image = frame.run(executor);
    CHECK(pixel(image, 64, 0, 0) == kSurfels);
    CHECK(pixel(image, 64, 31, 47) == kSurfels);
    CHECK(pixel(image, 64, 32, 0) == kTriangles);
    CHECK(pixel(image, 64, 63, 47) == kTriangles);

    REQUIRE(executor.plan().render_passes.size() == 1);
    CHECK(executor.plan().render_passes[0].subpasses.count == 4);
    CHECK(executor.statistics().passes == 5);
    CHECK(gpu.complaints().empty());
}

TEST_CASE("a steady frame creates no Vulkan object and compiles nothing") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    test::SurfelFrame frame(gpu.device, 32, 32);
    const std::vector<uint8_t> first = frame.run(executor);
    const graph::ExecutorStatistics before = executor.statistics();
    CHECK(before.objects_created > 0);
    const std::vector<uint8_t> second = frame.run(executor);
    CHECK(first == second);
    CHECK(executor.statistics().objects_created == before.objects_created);
    CHECK(executor.statistics().compilations == 1);
    CHECK(gpu.complaints().empty());
}

TEST_CASE("clear values and constants change without a new plan") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    test::SurfelFrame frame(gpu.device, 32, 32);
    frame.run(executor);
    frame.triangle_red = 1;
    CHECK(pixel(frame.run(executor), 32, 31, 0)[0] == 255);
    CHECK(executor.statistics().compilations == 1);
}

TEST_CASE("no combination of switches changes the image") {
    test::ValidatedDevice gpu;
    test::SurfelFrame reference_frame(gpu.device, 48, 32);
    graph::Executor reference(gpu.device);
    const std::vector<uint8_t> expected = reference_frame.run(reference);
    for (uint32_t bits = 0; bits < 32; ++bits) {
        graph::ExecutorOptions options;
        options.cull = (bits & 1) != 0;
        options.merge = (bits & 2) != 0;
        options.alias = (bits & 4) != 0;
        options.batch_barriers = (bits & 8) != 0;
        if ((bits & 16) != 0) options.random_order = bits;
        graph::Executor executor(gpu.device, options);
        test::SurfelFrame frame(gpu.device, 48, 32);
        CHECK(frame.run(executor) == expected);
        CHECK(frame.run(executor) == expected);
        CHECK(executor.statistics().render_passes == (options.merge ? 1U : 4U));
        const graph::ExecutorStatistics& statistics = executor.statistics();
        const uint32_t barriers = statistics.image_barriers + statistics.buffer_barriers;
        CHECK((statistics.barrier_commands == barriers) == !options.batch_barriers);
    }
    CHECK(gpu.complaints().empty());
}

TEST_CASE("a view mode without the surfel visibility pass draws the triangles only") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    test::SurfelFrame frame(gpu.device, 32, 32);
    const std::vector<uint8_t> both = frame.run(executor);
    frame.surfels = false;
    CHECK(pixel(frame.run(executor), 32, 0, 0) == kTriangles);
    frame.surfels = true;
    CHECK(frame.run(executor) == both);
    CHECK(executor.statistics().compilations == 2);
    CHECK(gpu.complaints().empty());
}

TEST_CASE("plans beyond the limit make room for new ones") {
    test::ValidatedDevice gpu;
    graph::ExecutorOptions options;
    options.max_plans = 1;
    graph::Executor executor(gpu.device, options);
    test::SurfelFrame frame(gpu.device, 32, 32);
    const std::vector<uint8_t> both = frame.run(executor);
    const uint64_t allocated = gpu.device.memory().statistics().allocated_bytes;
    for (int i = 0; i < 3; ++i) {
        frame.surfels = false;
        frame.run(executor);
        frame.surfels = true;
        CHECK(frame.run(executor) == both);
    }
    CHECK(gpu.device.memory().statistics().allocated_bytes == allocated);
    CHECK(gpu.complaints().empty());
}

TEST_CASE("passes have times under their names, a set for each frame in flight") {
    test::ValidatedDevice gpu;
    if (!gpu.device.features().timestamps) return;
    graph::ExecutorOptions options;
    options.frames_in_flight = 2;
    graph::Executor executor(gpu.device, options);
    test::SurfelFrame frame(gpu.device, 32, 32);
    frame.run(executor, 0);
    frame.run(executor, 1);
    for (const uint32_t slot : {0U, 1U}) {
        const std::vector<graph::PassTiming> timings = executor.timings(slot);
        REQUIRE(timings.size() == 5);
        CHECK(timings[0].name == "triangle");
        CHECK(timings[4].name == "read_back");
        for (const graph::PassTiming& timing : timings)
            CHECK(timing.gpu_ms >= 0);
    }
    CHECK(gpu.complaints().empty());
}

// One plan, so the same images: the barriers before their first use are all that keeps the frames apart.
TEST_CASE("frames that are submitted before those before them are done do not mix") {
    test::ValidatedDevice gpu;
    constexpr uint32_t kInFlight = 3;
    graph::ExecutorOptions options;
    options.frames_in_flight = kInFlight;
    graph::Executor executor(gpu.device, options);
    std::vector<std::unique_ptr<test::SurfelFrame>> frames;
    std::vector<std::vector<uint8_t>> alone;
    for (uint32_t slot = 0; slot < kInFlight; ++slot) {
        frames.push_back(std::make_unique<test::SurfelFrame>(gpu.device, 256, 256));
        frames.back()->triangle_red = 0.2F + 0.3F * static_cast<float>(slot);
        alone.push_back(frames.back()->run(executor, slot));
    }
    REQUIRE(alone[0] != alone[1]);

    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = gpu.device.queue_family();
    VkCommandPool pool = VK_NULL_HANDLE;
    REQUIRE(vkCreateCommandPool(gpu.device.handle(), &pool_info, nullptr, &pool) == VK_SUCCESS);
    const gpu::UniqueCommandPool owner(gpu.device.handle(), pool);
    std::array<VkCommandBuffer, kInFlight> commands{};
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool;
    allocate.commandBufferCount = kInFlight;
    REQUIRE(vkAllocateCommandBuffers(gpu.device.handle(), &allocate, commands.data()) == VK_SUCCESS);
    for (uint32_t slot = 0; slot < kInFlight; ++slot) {
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        REQUIRE(vkBeginCommandBuffer(commands[slot], &begin) == VK_SUCCESS);
        frames[slot]->record(executor, commands[slot], slot);
        REQUIRE(vkEndCommandBuffer(commands[slot]) == VK_SUCCESS);
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands[slot];
        REQUIRE(vkQueueSubmit(gpu.device.queue(), 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS);
    }
    gpu.device.wait_idle();
    CHECK(executor.statistics().compilations == 1);
    for (uint32_t slot = 0; slot < kInFlight; ++slot)
        CHECK(frames[slot]->pixels() == alone[slot]);
    CHECK(gpu.complaints().empty());
}

TEST_CASE("what each pass did is counted by the device where it can") {
    test::ValidatedDevice gpu;
    graph::ExecutorOptions options;
    options.pipeline_statistics = true;
    graph::Executor executor(gpu.device, options);
    test::SurfelFrame frame(gpu.device, 32, 32);
    for (int i = 0; i < 2; ++i)
        frame.run(executor);
    const std::vector<graph::PassTiming> timings = executor.timings();
    REQUIRE(timings.size() == 5);
    for (const graph::PassTiming& timing : timings) {
        CHECK(timing.counts.has_value() == (gpu.device.features().pipeline_statistics && timing.name != "read_back"));
    }
    if (gpu.device.features().pipeline_statistics) {
        CHECK(timings[0].counts->input_vertices == 3);
        CHECK(timings[0].counts->fragment_invocations >= 32 * 32);
        CHECK(timings[2].counts->input_vertices == 6);
    }
    CHECK(gpu.complaints().empty());
}
