// Compute passes, buffers and bindings on a device.
#include "engine/render_graph/executor/executor.h"
#include "engine/vulkan/transfer.h"
#include "shaders/fill_comp.h"
#include "tests/render_graph/device_fixture.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <numeric>

namespace {

using namespace splice;
using graph::Contents;

constexpr uint32_t kCount = 1000;

/// values[i] = values[i] * factor + i
class FillPass {
  public:
    explicit FillPass(gpu::Device& device)
        : device_(&device),
          shader_(device, fill_comp, "fill.comp"),
          set_layout_(device, {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}}),
          pool_(device) {
        const VkDescriptorSetLayout set = set_layout_.handle();
        layout_ = gpu::PipelineLayout(device, std::span(&set, 1), 8, VK_SHADER_STAGE_COMPUTE_BIT);
        pipeline_ = gpu::ComputePipeline(device, {&shader_, {}}, layout_.handle(), "fill");
    }
    void record(const graph::PassContext& context, graph::BufferHandle buffer, uint32_t factor) {
        const VkDescriptorSet set = pool_.allocate(set_layout_);
        gpu::DescriptorWriter(set).storage_buffer(0, context.buffer(buffer)).write(*device_);
        const uint32_t constants[2]{factor, kCount};
        vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle());
        vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 0, 1, &set, 0,
                                nullptr);
        vkCmdPushConstants(context.commands, layout_.handle(), VK_SHADER_STAGE_COMPUTE_BIT, 0, 8, constants);
        vkCmdDispatch(context.commands, (kCount + 63) / 64, 1, 1);
    }

  private:
    gpu::Device* device_;
    gpu::ShaderModule shader_;
    gpu::DescriptorSetLayout set_layout_;
    gpu::PipelineLayout layout_;
    gpu::ComputePipeline pipeline_;
    gpu::DescriptorPool pool_;
};

std::vector<uint32_t> values_of(const gpu::Buffer& buffer) {
    std::vector<uint32_t> values(kCount);
    std::memcpy(values.data(), buffer.mapped().data(), kCount * sizeof(uint32_t));
    return values;
}

}  // namespace

TEST_CASE("compute passes over transient and imported buffers see each other's results") {
    test::ValidatedDevice gpu;
    FillPass fill(gpu.device);
    const gpu::Buffer result(gpu.device, {kCount * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::readback, ""});

    graph::Graph graph;
    graph::BufferHandle scratch = graph.create_buffer("scratch", {kCount * 4});
    graph::BufferHandle copy_target = graph.create_buffer("copy", {kCount * 4});
    graph::ImportOptions import;
    import.after = graph::external::host_read();
    graph::BufferHandle out = graph.import_buffer("result", {kCount * 4}, import);

    graph::Pass zero = graph.add_pass("zero", graph::PassKind::transfer);
    scratch = zero.transfer_write(scratch, Contents::discard());
    zero.record([scratch](const graph::PassContext& context) {
        vkCmdFillBuffer(context.commands, context.buffer(scratch), 0, VK_WHOLE_SIZE, 0);
    });
    for (const uint32_t factor : {1U, 3U}) {
        graph::Pass pass = graph.add_pass("fill", graph::PassKind::compute);
        scratch = pass.storage_read_write(scratch);
        pass.record(
            [&fill, scratch, factor](const graph::PassContext& context) { fill.record(context, scratch, factor); });
    }
    const auto copy = [&](graph::BufferHandle from, graph::BufferHandle to) {
        graph::Pass pass = graph.add_pass("copy", graph::PassKind::transfer);
        pass.transfer_read(from);
        to = pass.transfer_write(to, Contents::discard());
        pass.record([from, to](const graph::PassContext& context) {
            const VkBufferCopy region{0, 0, kCount * 4};
            vkCmdCopyBuffer(context.commands, context.buffer(from), context.buffer(to), 1, &region);
        });
        return to;
    };
    copy_target = copy(scratch, copy_target);
    out = copy(copy_target, out);

    graph::Bindings bindings;
    bindings.bind(out, result);
    graph::Executor executor(gpu.device);
    for (int frame = 0; frame < 2; ++frame) {
        gpu.device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(graph, bindings, commands); });
        std::vector<uint32_t> expected(kCount);
        std::iota(expected.begin(), expected.end(), 0U);
        for (uint32_t& value : expected)
            value *= 4;  // (0 + i) * 3 + i
        CHECK(values_of(result) == expected);
    }
    CHECK(gpu.complaints().empty());
}

TEST_CASE("an imported image is left in the layout that was asked for") {
    test::ValidatedDevice gpu;
    gpu::ImageOptions options;
    options.format = VK_FORMAT_R8G8B8A8_UNORM;
    options.width = options.height = 8;
    options.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const gpu::Image image(gpu.device, options);
    graph::Graph graph;
    graph::ImportOptions import;
    import.after = graph::external::transfer_read();
    graph::ImageHandle target = graph.import_image("target", {options.format, 8, 8}, import);
    graph::Pass clear = graph.add_pass("clear", graph::PassKind::graphics);
    clear.colour_attachment(target, Contents::clear(graph::clear_colour(1, 0, 1, 0)));
    graph::Bindings bindings;
    bindings.bind(target, image);
    graph::Executor executor(gpu.device);
    gpu.device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(graph, bindings, commands); });
    const std::vector<std::byte> bytes = gpu::read_back(gpu.device, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    CHECK(bytes[0] == std::byte{255});
    CHECK(bytes[1] == std::byte{0});
    CHECK(bytes[2] == std::byte{255});
    CHECK(gpu.complaints().empty());
}

TEST_CASE("bindings that are missing or do not match are refused by name") {
    test::ValidatedDevice gpu;
    gpu::ImageOptions options;
    options.format = VK_FORMAT_R8G8B8A8_UNORM;
    options.width = options.height = 8;
    options.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const gpu::Image image(gpu.device, options);
    graph::Graph graph;
    const auto declare = [&](uint32_t width) {
        graph.clear();
        const graph::ImageHandle target = graph.import_image("target", {options.format, width, 8}, {});
        graph::Pass clear = graph.add_pass("clear", graph::PassKind::graphics);
        clear.colour_attachment(target, Contents::clear(graph::clear_colour(1, 0, 1, 0)));
        return target;
    };
    graph::Executor executor(gpu.device);
    const auto execute = [&](const graph::Bindings& bindings) {
        gpu.device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(graph, bindings, commands); });
    };
    const graph::ImageHandle target = declare(8);
    CHECK_THROWS_WITH(execute({}), Catch::Contains("image 'target'") && Catch::Contains("not bound"));
    graph::Bindings bindings;
    bindings.bind(target, image);
    CHECK_THROWS_WITH(execute(bindings), Catch::Contains("image 'target'") && Catch::Contains("usage"));
    declare(9);
    CHECK_THROWS_WITH(execute(bindings), Catch::Contains("image 'target'") && Catch::Contains("8 x 8 pixels") &&
                                             Catch::Contains("declaration, 9 x 8 pixels"));
    const graph::ImageHandle unknown{7, 0, graph.id()};
    graph::Bindings wrong;
    wrong.bind(unknown, image);
    CHECK_THROWS_WITH(execute(wrong), Catch::Contains("resource 7 of 1") && Catch::Contains("import_image"));
    CHECK_THROWS_WITH(executor.execute(graph, bindings, VK_NULL_HANDLE, 3),
                      Catch::Contains("frame slot 3") && Catch::Contains("slots 0 to 0"));
    CHECK(gpu.complaints().empty());
}

TEST_CASE("an invalid frame is refused each time, and frames that look alike have plans of their own") {
    test::ValidatedDevice gpu;
    graph::ExecutorOptions options;
    options.cull = false;
    graph::Executor executor(gpu.device, options);
    graph::Graph graph;
    int recorded = 0;
    const auto declare = [&](bool reads) {
        graph.clear();
        const graph::ImageHandle colour = graph.create_image("colour", {VK_FORMAT_R8G8B8A8_UNORM, 64, 64});
        const graph::ImageHandle depth =
            graph.import_image("depth", {VK_FORMAT_D32_SFLOAT, 64, 64},
                               {.before = {{VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT, 0},
                                           VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}});
        const auto count = [&](const graph::PassContext&) { ++recorded; };
        graph::Pass draw = graph.add_pass("draw", graph::PassKind::graphics);
        draw.colour_attachment(colour, Contents::discard());
        draw.record(count);
        if (reads) {
            draw.depth_stencil_read(depth);
        } else {
            graph.add_pass("empty compute", graph::PassKind::compute).record(count);
            graph.add_pass("empty transfer", graph::PassKind::transfer).record(count);
        }
    };
    const auto execute = [&] {
        gpu.device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(graph, {}, commands); });
    };
    declare(false);
    execute();
    CHECK(recorded == 3);
    declare(true);
    CHECK_THROWS_WITH(execute(), Catch::Contains("image 'depth'") && Catch::Contains("not bound"));
    CHECK(executor.statistics().compilations == 2);

    declare(false);
    graph.add_pass("nowhere", graph::PassKind::graphics);
    for (int frame = 0; frame < 2; ++frame)
        CHECK_THROWS_WITH(execute(), Catch::Contains("pass 'nowhere'") && Catch::Contains("needs an attachment"));
    CHECK(executor.statistics().compilations == 2);
    CHECK(recorded == 3);
    CHECK(gpu.complaints().empty());
}
