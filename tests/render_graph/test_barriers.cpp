// Barriers on frames small enough to write them down by hand.
#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "tests/render_graph/hazard_checker.h"

#include <catch2/catch.hpp>

namespace {

using namespace splice;
using graph::Contents;
using graph::PassKind;
using graph::Scope;

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;
const Contents kClear = Contents::clear(VkClearValue{});
constexpr Scope kComputeRead{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT};
constexpr Scope kComputeWrite{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT};
constexpr Scope kTransferRead{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT};
constexpr Scope kTransferWrite{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};

graph::BufferHandle imported_buffer(graph::Graph& graph, const graph::ExternalUse& before,
                                    const graph::ExternalUse& after) {
    graph::ImportOptions import;
    import.before = before;
    import.after = after;
    return graph.import_buffer("imported", {64}, import);
}

}  // namespace

TEST_CASE("write, reads, write: one barrier before the reads, one that only orders before the write") {
    graph::Graph graph;
    auto buffer = imported_buffer(graph, graph::external::none(), graph::external::none());
    auto write = graph.add_pass("write", PassKind::transfer);
    buffer = write.transfer_write(buffer, Contents::discard());
    for (int i = 0; i < 3; ++i) {
        auto read = graph.add_pass("read", PassKind::compute);
        i == 1 ? read.indirect_buffer(buffer) : read.storage_read(buffer);
        read.side_effect();
    }
    auto again = graph.add_pass("again", PassKind::transfer);
    buffer = again.transfer_write(buffer, Contents::discard());
    const graph::Plan plan = graph::compile(graph, {.cull = false});
    REQUIRE(plan.buffer_barriers.size() == 2);
    CHECK(plan.groups[0].barriers.empty());
    const Scope reads{kComputeRead.stages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                      kComputeRead.access | VK_ACCESS_INDIRECT_COMMAND_READ_BIT};
    CHECK(plan.groups[1].barriers.buffers == graph::Range{0, 1});
    CHECK(plan.buffer_barriers[0] == graph::BufferBarrier{buffer.resource, kTransferWrite, reads});
    CHECK(plan.groups[4].barriers.buffers == graph::Range{1, 1});
    CHECK(plan.buffer_barriers[1] == graph::BufferBarrier{buffer.resource, {reads.stages, 0}, kTransferWrite});
    CHECK(test::find_hazards(graph, plan).empty());
}

TEST_CASE("an image that is drawn, then sampled, then copied changes layout twice") {
    graph::Graph graph;
    auto image = graph.create_image("image", {kColour, 8, 8});
    auto result = imported_buffer(graph, graph::external::none(), graph::external::host_read());
    auto draw = graph.add_pass("draw", PassKind::graphics);
    image = draw.colour_attachment(image, kClear);
    auto measure = graph.add_pass("measure", PassKind::compute);
    measure.sampled(image);
    measure.side_effect();
    auto copy = graph.add_pass("copy", PassKind::transfer);
    copy.transfer_read(image);
    result = copy.transfer_write(result, Contents::discard());
    const graph::Plan plan = graph::compile(graph);
    constexpr VkPipelineStageFlags output = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    constexpr VkAccessFlags colour_write = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    REQUIRE(plan.image_barriers.size() == 3);
    // First use: whatever the copy of the frame before still reads; contents are not needed.
    CHECK(plan.image_barriers[0] == graph::ImageBarrier{image.resource,
                                                        {VK_PIPELINE_STAGE_TRANSFER_BIT, 0},
                                                        {output, VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | colour_write},
                                                        VK_IMAGE_LAYOUT_UNDEFINED,
                                                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    CHECK(plan.image_barriers[1] == graph::ImageBarrier{image.resource,
                                                        {output, colour_write},
                                                        kComputeRead,
                                                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    CHECK(plan.image_barriers[2] == graph::ImageBarrier{image.resource,
                                                        {kComputeRead.stages, 0},
                                                        kTransferRead,
                                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    // The result goes to the host.
    CHECK(plan.final_barriers.buffers.count == 1);
    CHECK(plan.buffer_barriers.back() ==
          graph::BufferBarrier{result.resource, kTransferWrite, graph::external::host_read().scope});
    CHECK(test::find_hazards(graph, plan).empty());
}

TEST_CASE("barriers of all resources before a group are one batch") {
    graph::Graph graph;
    std::vector<graph::BufferHandle> buffers;
    for (int i = 0; i < 4; ++i)
        buffers.push_back(graph.create_buffer("buffer", {64}));
    auto write = graph.add_pass("write", PassKind::compute);
    for (auto& buffer : buffers)
        buffer = write.storage_write(buffer, Contents::discard());
    auto read = graph.add_pass("read", PassKind::compute);
    for (const auto& buffer : buffers)
        read.storage_read(buffer);
    read.side_effect();
    const graph::Plan plan = graph::compile(graph);
    CHECK(plan.groups[1].barriers.buffers == graph::Range{4, 4});
    CHECK(plan.buffer_barriers[4] == graph::BufferBarrier{buffers[0].resource, kComputeWrite, kComputeRead});
    // And once a frame, the reads of the frame before.
    CHECK(plan.buffer_barriers[0] ==
          graph::BufferBarrier{buffers[0].resource, {kComputeRead.stages, 0}, kComputeWrite});
}

TEST_CASE("imported resources begin and end as the outside says") {
    graph::Graph graph;
    graph::ImportOptions import;
    SECTION("contents written outside are waited for") {
        auto buffer = imported_buffer(graph, {kTransferWrite, VK_IMAGE_LAYOUT_UNDEFINED}, graph::external::none());
        auto read = graph.add_pass("read", PassKind::compute);
        read.storage_read(buffer);
        read.side_effect();
        const graph::Plan plan = graph::compile(graph);
        REQUIRE(plan.buffer_barriers.size() == 1);
        CHECK(plan.buffer_barriers[0] == graph::BufferBarrier{buffer.resource, kTransferWrite, kComputeRead});
    }
    SECTION("a static buffer needs nothing") {
        auto buffer = imported_buffer(graph, graph::external::none(), graph::external::none());
        auto read = graph.add_pass("read", PassKind::compute);
        read.storage_read(buffer);
        read.side_effect();
        CHECK(graph::compile(graph).buffer_barriers.empty());
    }
    SECTION("a texture that stays in its layout needs nothing") {
        import.before = import.after = graph::external::sampled();
        auto texture = graph.import_image("texture", {kColour, 8, 8}, import);
        auto read = graph.add_pass("read", PassKind::compute);
        read.sampled(texture);
        read.side_effect();
        CHECK(graph::compile(graph).image_barriers.empty());
    }
    SECTION("a target is presented even if nothing draws to it") {
        import.after = graph::external::present();
        auto target = graph.import_image("target", {kColour, 8, 8}, import);
        const graph::Plan plan = graph::compile(graph);
        REQUIRE(plan.final_barriers.images.count == 1);
        CHECK(plan.image_barriers[0].resource == target.resource);
        CHECK(plan.image_barriers[0].new_layout == VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    }
    SECTION("what is overwritten need not survive its transition") {
        import.before = graph::external::sampled();
        auto target = graph.import_image("target", {kColour, 8, 8}, import);
        graph.add_pass("draw", PassKind::graphics).colour_attachment(target, kClear);
        const graph::Plan plan = graph::compile(graph);
        REQUIRE(plan.image_barriers.size() == 1);
        CHECK(plan.image_barriers[0].old_layout == VK_IMAGE_LAYOUT_UNDEFINED);
        CHECK(plan.image_barriers[0].source == Scope{import.before.scope.stages, 0});
    }
}

TEST_CASE("a read-only attachment is neither stored nor in the way of other readers") {
    graph::Graph graph;
    auto depth = graph.create_image("depth", {VK_FORMAT_D32_SFLOAT, 8, 8});
    graph::ImportOptions import;
    import.after = graph::external::sampled();
    auto target = graph.import_image("target", {kColour, 8, 8}, import);
    auto fill = graph.add_pass("fill", PassKind::graphics);
    depth = fill.depth_stencil_attachment(depth, kClear);
    auto shade = graph.add_pass("shade", PassKind::compute);
    shade.sampled(depth);
    shade.side_effect();
    auto draw = graph.add_pass("draw", PassKind::graphics);
    draw.depth_stencil_read(depth);
    target = draw.colour_attachment(target, kClear);
    const graph::Plan plan = graph::compile(graph, {.merge = false});
    // Both readers share one barrier: from the writer to either.
    uint32_t barriers = 0;
    for (const graph::ImageBarrier& barrier : plan.image_barriers)
        barriers += barrier.resource == depth.resource;
    CHECK(barriers == 2);
    const graph::RenderPass& last = plan.render_passes[1];
    for (const graph::Attachment& attachment : slice(plan.attachments, last.attachments)) {
        if (attachment.resource != depth.resource) continue;
        CHECK(attachment.load == VK_ATTACHMENT_LOAD_OP_LOAD);
        CHECK(attachment.store == VK_ATTACHMENT_STORE_OP_NONE);
    }
    CHECK(test::find_hazards(graph, plan).empty());
}

TEST_CASE("what readers with a barrier each saw of a history is made visible anew to those of the next frame") {
    graph::Graph graph;
    constexpr graph::ImageDescription description{VK_FORMAT_R8G8B8A8_UNORM, 8, 8};
    const graph::ImageHistory history = graph.create_history_image("history", description, {});
    const graph::ImageHandle target = graph.create_image("target", description);
    auto blend = graph.add_pass("blend", graph::PassKind::graphics);
    blend.sampled(history.previous, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
    const auto current = blend.colour_attachment(history.current, graph::Contents::discard());
    blend.side_effect();
    auto displace = graph.add_pass("displace", graph::PassKind::graphics);
    displace.sampled(current, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT);
    const auto drawn = displace.colour_attachment(target, graph::Contents::discard());
    displace.side_effect();
    auto show = graph.add_pass("show", graph::PassKind::graphics);
    show.input_attachment(current);
    show.colour_attachment(drawn, graph::Contents::keep());
    show.side_effect();
    for (const bool batch : {true, false}) {
        graph::CompileOptions options;
        options.batch_barriers = batch;
        CHECK(test::find_hazards(graph, graph::compile(graph, options)).empty());
    }
}
