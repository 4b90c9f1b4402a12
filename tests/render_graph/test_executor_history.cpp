// Contents that live across frames, on a device.
#include "engine/render_graph/executor/executor.h"
#include "engine/vulkan/buffer.h"
#include "tests/render_graph/device_fixture.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <vector>

namespace {

using namespace splice;
using graph::Contents;

/// Each frame leaves its number, in an image and in a buffer, and copies out what the last frame left.
struct CountingFrame {
    explicit CountingFrame(gpu::Device& device_) : device(device_) {
        for (int slot = 0; slot < 3; ++slot)
            results.emplace_back(
                device_, gpu::BufferOptions{16, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::readback, "result"});
    }

    void record(graph::Executor& executor, VkCommandBuffer commands, uint32_t slot = 0) {
        ++number;
        graph::Graph frame;
        const auto out = frame.import_buffer("result", {16}, {.after = graph::external::host_read()});
        const auto image = frame.create_history_image("colour", {VK_FORMAT_R32_SFLOAT, size, size},
                                                      graph::clear_colour(initial, 0, 0, 0));
        const auto buffer = frame.create_history_buffer("counter", {4});

        graph::Pass draw = frame.add_pass("draw", graph::PassKind::graphics);
        draw.colour_attachment(image.current,
                               Contents::clear(graph::clear_colour(static_cast<float>(number), 0, 0, 0)));
        graph::Pass fill = frame.add_pass("fill", graph::PassKind::transfer);
        fill.transfer_write(buffer.current, Contents::discard());
        fill.record([&, target = buffer.current](const graph::PassContext& context) {
            vkCmdFillBuffer(context.commands, context.buffer(target), 0, VK_WHOLE_SIZE, number);
        });
        graph::Pass copy = frame.add_pass("copy", graph::PassKind::transfer);
        copy.transfer_read(image.previous);
        copy.transfer_read(buffer.previous);
        copy.transfer_write(out, Contents::discard());
        copy.record([=](const graph::PassContext& context) {
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageExtent = {1, 1, 1};
            vkCmdCopyImageToBuffer(context.commands, context.image(image.previous),
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.buffer(out), 1, &region);
            const VkBufferCopy bytes{0, 4, 4};
            vkCmdCopyBuffer(context.commands, context.buffer(buffer.previous), context.buffer(out), 1, &bytes);
        });
        graph::Bindings bindings;
        bindings.bind(out, results[slot]);
        executor.execute(frame, bindings, commands, slot);
    }

    /// What the frame found of the last one: in the image, in the buffer.
    std::pair<float, uint32_t> run(graph::Executor& executor) {
        device.submit_and_wait([&](VkCommandBuffer commands) { record(executor, commands); });
        std::pair<float, uint32_t> found;
        std::memcpy(&found.first, results[0].mapped().data(), 4);
        std::memcpy(&found.second, results[0].mapped().data() + 4, 4);
        return found;
    }

    gpu::Device& device;
    std::vector<gpu::Buffer> results;  // one a slot
    uint32_t size = 16, number = 0;
    float initial = -1;
};

using Found = std::pair<float, uint32_t>;

}  // namespace

TEST_CASE("a frame finds what the last one left, the first the initial contents") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    CountingFrame frame(gpu.device);
    CHECK(frame.run(executor) == Found{-1.0F, 0});
    CHECK(frame.run(executor) == Found{1.0F, 1});
    const uint64_t created = executor.statistics().objects_created;
    for (uint32_t number = 2; number < 6; ++number)
        CHECK(frame.run(executor) == Found{static_cast<float>(number), number});
    CHECK(executor.statistics().objects_created == created);
    CHECK(gpu.complaints() == "");
}

TEST_CASE("a history begins anew after a resize and after another frame") {
    test::ValidatedDevice gpu;
    graph::Executor executor(gpu.device);
    CountingFrame frame(gpu.device);
    frame.run(executor);
    frame.initial = 7;
    CHECK(frame.run(executor) == Found{1.0F, 1});
    frame.size = 32;
    CHECK(frame.run(executor) == Found{7.0F, 0});
    CHECK(frame.run(executor) == Found{3.0F, 3});
    frame.size = 16;
    CHECK(frame.run(executor) == Found{7.0F, 0});
    CHECK(gpu.complaints() == "");
}

TEST_CASE("frames in flight hand histories on without the host between them") {
    test::ValidatedDevice gpu;
    graph::ExecutorOptions options;
    options.frames_in_flight = 3;
    graph::Executor executor(gpu.device, options);
    CountingFrame frame(gpu.device);
    gpu.device.submit_and_wait([&](VkCommandBuffer commands) {
        for (const uint32_t slot : {0U, 1U, 2U})
            frame.record(executor, commands, slot);
    });
    CHECK(frame.run(executor) == Found{3.0F, 3});
    CHECK(gpu.complaints() == "");
}
