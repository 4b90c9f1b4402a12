// Order, culling and merging on frames small enough to judge by hand.
#include "engine/render_graph/compile.h"
#include "engine/render_graph/export/export.h"
#include "engine/render_graph/graph.h"
#include "tests/render_graph/hazard_checker.h"

#include <catch2/catch.hpp>

namespace {

using namespace splice;
using Catch::Contains;
using graph::Contents;
using graph::PassKind;
using Passes = std::vector<uint32_t>;

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;
const Contents kClear = Contents::clear(VkClearValue{});

graph::ImageHandle imported_target(graph::Graph& graph, const std::string& name) {
    graph::ImportOptions import;
    import.after = graph::external::sampled();
    return graph.import_image(name, {kColour, 64, 64}, import);
}

/// The frame in the header of graph.h; an order of declaration that a compiler must not be confused by is up to
/// `early`, a compute pass that the visibility pass needs.
graph::Graph renderer_frame(bool with_compute = false) {
    graph::Graph frame;
    auto colour = frame.create_image("colour", {VK_FORMAT_R8G8B8A8_SRGB, 64, 48});
    auto depth = frame.create_image("depth", {kDepth, 64, 48});
    auto accumulation = frame.create_image("accumulation", {VK_FORMAT_R32G32B32A32_SFLOAT, 64, 48});
    auto image = frame.create_image("image", {VK_FORMAT_R8G8B8A8_SRGB, 64, 48});
    auto list = frame.create_buffer("surfel_list", {4096});
    graph::ImportOptions import;
    import.after = graph::external::host_read();
    auto pixels = frame.import_buffer("pixels", {64 * 48 * 4}, import);

    auto triangles = frame.add_pass("triangle", PassKind::graphics);
    colour = triangles.colour_attachment(colour, kClear);
    depth = triangles.depth_stencil_attachment(depth, kClear);
    if (with_compute) {
        auto cull = frame.add_pass("surfel_cull", PassKind::compute);
        list = cull.storage_write(list, Contents::discard());
    }
    auto visibility = frame.add_pass("surfel_visibility", PassKind::graphics);
    depth = visibility.depth_stencil_attachment(depth, Contents::keep());
    if (with_compute) visibility.storage_read(list, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT);
    auto attributes = frame.add_pass("surfel_attribute", PassKind::graphics);
    accumulation = attributes.colour_attachment(accumulation, kClear);
    attributes.depth_stencil_read(depth);
    if (with_compute) attributes.storage_read(list, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT);
    auto normalise = frame.add_pass("surfel_normalise", PassKind::graphics);
    normalise.input_attachment(colour);
    normalise.input_attachment(accumulation);
    normalise.depth_stencil_read(depth);
    image = normalise.colour_attachment(image, Contents::discard());
    auto copy = frame.add_pass("read_back", PassKind::transfer);
    copy.transfer_read(image);
    copy.transfer_write(pixels, Contents::discard());
    return frame;
}

}  // namespace

TEST_CASE("the renderer's frame becomes one render pass of four subpasses") {
    const graph::Graph frame = renderer_frame();
    const graph::Plan plan = graph::compile(frame);
    CHECK(plan.order == Passes{0, 1, 2, 3, 4});
    REQUIRE(plan.groups.size() == 2);
    CHECK(plan.groups[0].passes.count == 4);
    REQUIRE(plan.render_passes.size() == 1);
    CHECK(plan.culled.empty());
    CHECK(plan.unmerged.empty());
    const graph::RenderPass& render_pass = plan.render_passes[0];
    CHECK(render_pass.width == 64);
    CHECK(render_pass.height == 48);

    // Attachments in order of first use: colour, depth, accumulation, image.
    const auto attachments = slice(plan.attachments, render_pass.attachments);
    REQUIRE(attachments.size() == 4);
    CHECK(attachments[0].load == VK_ATTACHMENT_LOAD_OP_CLEAR);
    CHECK(attachments[0].store == VK_ATTACHMENT_STORE_OP_DONT_CARE);
    CHECK(attachments[0].initial_layout == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    CHECK(attachments[0].final_layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    CHECK(attachments[1].load == VK_ATTACHMENT_LOAD_OP_CLEAR);
    CHECK(attachments[1].stencil_load == VK_ATTACHMENT_LOAD_OP_CLEAR);
    CHECK(attachments[1].store == VK_ATTACHMENT_STORE_OP_DONT_CARE);
    CHECK(attachments[1].stencil_store == VK_ATTACHMENT_STORE_OP_DONT_CARE);
    CHECK(attachments[1].initial_layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    CHECK(attachments[1].final_layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    CHECK(attachments[2].load == VK_ATTACHMENT_LOAD_OP_CLEAR);
    CHECK(attachments[2].stencil_load == VK_ATTACHMENT_LOAD_OP_DONT_CARE);
    CHECK(attachments[3].load == VK_ATTACHMENT_LOAD_OP_DONT_CARE);
    CHECK(attachments[3].store == VK_ATTACHMENT_STORE_OP_STORE);
    // What lives and dies in the render pass needs no memory on a tiler.
    CHECK(plan.resources[0].memoryless);
    CHECK(plan.resources[1].memoryless);
    CHECK(plan.resources[2].memoryless);
    CHECK_FALSE(plan.resources[3].memoryless);

    const auto subpasses = slice(plan.subpasses, render_pass.subpasses);
    REQUIRE(subpasses.size() == 4);
    const auto preserved = [&](uint32_t subpass) {
        const auto found = slice(plan.preserved, subpasses[subpass].preserved);
        return Passes(found.begin(), found.end());
    };
    CHECK(preserved(0).empty());
    CHECK(preserved(1) == Passes{0});
    CHECK(preserved(2) == Passes{0});
    CHECK(preserved(3).empty());
    const auto inputs = slice(plan.references, subpasses[3].inputs);
    REQUIRE(inputs.size() == 2);
    CHECK(inputs[0].attachment == 0);
    CHECK(inputs[1].attachment == 2);
    CHECK(inputs[1].layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    CHECK(inputs[1].aspects == VK_IMAGE_ASPECT_COLOR_BIT);
    const auto depth = slice(plan.references, subpasses[2].depth_stencil);
    REQUIRE(depth.size() == 1);
    CHECK(depth[0].layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);

    constexpr VkPipelineStageFlags tests =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkAccessFlags depth_read = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    constexpr VkAccessFlags depth_write = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const auto dependencies = slice(plan.dependencies, render_pass.dependencies);
    REQUIRE(dependencies.size() == 5);
    CHECK(dependencies[0] == graph::SubpassDependency{0, 1, {tests, depth_write}, {tests, depth_read | depth_write}});
    CHECK(dependencies[1] == graph::SubpassDependency{
                                 0,
                                 3,
                                 {VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
                                 {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_INPUT_ATTACHMENT_READ_BIT}});
    CHECK(dependencies[2] == graph::SubpassDependency{1, 2, {tests, depth_write}, {tests, depth_read}});
    CHECK(dependencies[3] == graph::SubpassDependency{1, 3, {tests, depth_write}, {tests, depth_read}});
    // Accumulation from attribute to normalise; and the depth that attribute reads is discarded when normalise ends.
    CHECK(dependencies[4].source == 2);
    CHECK(dependencies[4].destination == 3);
    CHECK(dependencies[4].source_scope.access == VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    CHECK((dependencies[4].destination_scope.access & VK_ACCESS_INPUT_ATTACHMENT_READ_BIT) != 0);
    CHECK(test::find_hazards(frame, plan).empty());
}

TEST_CASE("a compute pass declared between two subpasses is moved before the render pass") {
    const graph::Graph frame = renderer_frame(true);
    const graph::Plan plan = graph::compile(frame);
    CHECK(plan.order == Passes{1, 0, 2, 3, 4, 5});
    REQUIRE(plan.render_passes.size() == 1);
    CHECK(plan.render_passes[0].subpasses.count == 4);
    CHECK(test::find_hazards(frame, plan).empty());
}

TEST_CASE("passes whose results nobody needs are culled, with the reason") {
    graph::Graph graph;
    auto a = graph.create_image("a", {kColour, 64, 64});
    auto b = graph.create_image("b", {kColour, 64, 64});
    auto c = graph.create_image("c", {kColour, 64, 64});
    auto target = imported_target(graph, "target");
    auto overdrawn = graph.add_pass("overdrawn", PassKind::graphics);
    target = overdrawn.colour_attachment(target, kClear);
    auto unread = graph.add_pass("unread", PassKind::graphics);
    a = unread.colour_attachment(a, kClear);
    auto source = graph.add_pass("source", PassKind::graphics);
    b = source.colour_attachment(b, kClear);
    auto filter = graph.add_pass("filter", PassKind::compute);
    filter.sampled(b);
    c = filter.storage_write(c, Contents::discard());
    graph.add_pass("idle", PassKind::compute);
    auto present = graph.add_pass("present", PassKind::graphics);
    target = present.colour_attachment(target, kClear);
    auto print = graph.add_pass("print", PassKind::compute);
    print.side_effect();

    const graph::Plan plan = graph::compile(graph);
    CHECK(plan.order == Passes{5, 6});
    REQUIRE(plan.culled.size() == 5);
    const auto reason = [&](size_t i) { return graph::explain(graph, plan.culled[i]); };
    CHECK(reason(0) == "pass 'overdrawn' is culled: pass 'present' overwrites image 'target' before anything reads it");
    CHECK(reason(1) == "pass 'unread' is culled: nothing reads image 'a'");
    CHECK(reason(2) == "pass 'source' is culled: what reads image 'b' is culled, pass 'filter' for one");
    CHECK(reason(3) == "pass 'filter' is culled: nothing reads image 'c'");
    CHECK(reason(4) == "pass 'idle' is culled: it writes nothing and has no side effect");
    CHECK(plan.resources[a.resource].lifetime.first_group == graph::none);

    graph::CompileOptions keep;
    keep.cull = false;
    CHECK(graph::compile(graph, keep).order.size() == 7);
}

TEST_CASE("an imported resource that nobody wants does not keep its writers") {
    graph::Graph graph;
    graph::ImportOptions import;
    import.wanted = false;
    auto scratch = graph.import_image("scratch", {kColour, 64, 64}, import);
    graph.add_pass("draw", PassKind::graphics).colour_attachment(scratch, kClear);
    CHECK(graph::compile(graph).order.empty());
}

TEST_CASE("a pass that samples what another draws is not merged with it") {
    graph::Graph graph;
    auto a = graph.create_image("a", {kColour, 64, 64});
    auto target = imported_target(graph, "target");
    auto draw = graph.add_pass("draw", PassKind::graphics);
    a = draw.colour_attachment(a, kClear);
    auto use = graph.add_pass("use", PassKind::graphics);
    use.sampled(a);
    use.colour_attachment(target, kClear);
    const graph::Plan plan = graph::compile(graph);
    CHECK(plan.render_passes.size() == 2);
    REQUIRE(plan.unmerged.size() == 1);
    CHECK(graph::explain(graph, plan.unmerged[0]) ==
          "pass 'use' is not merged with pass 'draw': image 'a' is not used as an attachment by all of them");
}

TEST_CASE("a pass is not merged where another must run between") {
    graph::Graph graph;
    auto target = imported_target(graph, "target");
    auto a = graph.create_image("a", {kColour, 64, 64});
    auto blurred = graph.create_image("blurred", {kColour, 64, 64});
    auto draw = graph.add_pass("draw", PassKind::graphics);
    target = draw.colour_attachment(target, kClear);
    a = draw.colour_attachment(a, kClear);
    auto blur = graph.add_pass("blur", PassKind::compute);
    blur.sampled(a);
    blurred = blur.storage_write(blurred, Contents::discard());
    auto compose = graph.add_pass("compose", PassKind::graphics);
    compose.sampled(blurred);
    target = compose.colour_attachment(target, Contents::keep());
    const graph::Plan plan = graph::compile(graph);
    CHECK(plan.order == Passes{0, 1, 2});
    CHECK(plan.render_passes.size() == 2);
    REQUIRE(plan.unmerged.size() == 1);
    CHECK(plan.unmerged[0].reason == graph::UnmergedReason::pass_between);
    CHECK(graph::explain(graph, plan.unmerged[0]) ==
          "pass 'compose' is not merged with pass 'draw': pass 'blur' depends on a pass of the group and must run "
          "before it");
    // The first writes the target's memory, the second finds it there.
    CHECK(plan.attachments[0].store == VK_ATTACHMENT_STORE_OP_STORE);
    CHECK(plan.attachments[plan.render_passes[1].attachments.first].load == VK_ATTACHMENT_LOAD_OP_LOAD);
    CHECK(test::find_hazards(graph, plan).empty());
}

TEST_CASE("two merged groups never wait for each other") {
    // a0 -> c0 and b0 -> d0 would merge; but c0 samples b0's side image and d0 (through b1) that of a0: only one may.
    graph::Graph graph;
    auto left = imported_target(graph, "left"), right = imported_target(graph, "right");
    auto left_side = graph.create_image("left_side", {kColour, 64, 64});
    auto right_side = graph.create_image("right_side", {kColour, 64, 64});
    auto a = graph.add_pass("a", PassKind::graphics);
    left = a.colour_attachment(left, kClear);
    left_side = a.colour_attachment(left_side, kClear);
    auto b = graph.add_pass("b", PassKind::graphics);
    right = b.colour_attachment(right, kClear);
    right_side = b.colour_attachment(right_side, kClear);
    auto c = graph.add_pass("c", PassKind::graphics);
    left = c.colour_attachment(left, Contents::keep());
    c.sampled(right_side);
    auto d = graph.add_pass("d", PassKind::graphics);
    right = d.colour_attachment(right, Contents::keep());
    d.sampled(left_side);
    const graph::Plan plan = graph::compile(graph);
    CHECK(plan.order.size() == 4);
    CHECK(plan.render_passes.size() == 3);
    CHECK(test::find_hazards(graph, plan).empty());
}

TEST_CASE("a second clear, another size and the switch keep passes apart, with the reason") {
    graph::Graph graph;
    auto target = imported_target(graph, "target");
    auto first = graph.add_pass("first", PassKind::graphics);
    target = first.colour_attachment(target, kClear);
    auto second = graph.add_pass("second", PassKind::graphics);
    second.input_attachment(target);
    auto other = graph.create_image("other", {kColour, 64, 64});
    other = second.colour_attachment(other, kClear);
    second.side_effect();
    auto third = graph.add_pass("third", PassKind::graphics);
    target = third.colour_attachment(target, kClear);
    const graph::Plan plan = graph::compile(graph);
    REQUIRE(plan.unmerged.size() == 1);
    CHECK(graph::explain(graph, plan.unmerged[0]) ==
          "pass 'third' is not merged with pass 'second': it clears image 'target', which is in use before");
    graph::CompileOptions apart;
    apart.merge = false;
    const graph::Plan separate = graph::compile(graph, apart);
    CHECK(separate.render_passes.size() == 3);
    CHECK(separate.unmerged[0].reason == graph::UnmergedReason::switched_off);
    CHECK(test::find_hazards(graph, plan).empty());
    CHECK(test::find_hazards(graph, separate).empty());
}

TEST_CASE("a chain of a thousand pixel-local passes merges into one render pass") {
    graph::Graph graph;
    auto target = imported_target(graph, "target");
    for (int i = 0; i < 1000; ++i) {
        auto pass = graph.add_pass("blend", PassKind::graphics);
        target = pass.colour_attachment(target, i == 0 ? kClear : Contents::keep());
    }
    const graph::Plan plan = graph::compile(graph);
    REQUIRE(plan.render_passes.size() == 1);
    CHECK(plan.render_passes[0].dependencies.count == 999);
}

TEST_CASE("lifetimes, usage and aliasing") {
    graph::Graph graph;
    auto a = graph.create_image("a", {kColour, 64, 64});
    auto b = graph.create_image("b", {kColour, 64, 64});
    auto c = graph.create_image("c", {kColour, 64, 64});
    auto target = imported_target(graph, "target");
    const auto step = [&](graph::ImageHandle from, graph::ImageHandle to) {
        auto pass = graph.add_pass("step", PassKind::compute);
        pass.sampled(from);
        return pass.storage_write(to, Contents::discard());
    };
    auto fill = graph.add_pass("fill", PassKind::transfer);
    a = fill.transfer_write(a, Contents::discard());
    b = step(a, b);
    c = step(b, c);
    target = step(c, target);
    graph::CompileOptions options;
    options.memory = [](uint32_t, const graph::PlannedResource&) { return graph::MemoryRequirement{1000, 256, 1}; };
    const graph::Plan plan = graph::compile(graph, options);
    CHECK(plan.resources[a.resource].lifetime == graph::Lifetime{0, 1});
    CHECK(plan.resources[b.resource].lifetime == graph::Lifetime{1, 2});
    CHECK(plan.resources[c.resource].lifetime == graph::Lifetime{2, 3});
    CHECK(plan.resources[a.resource].image_usage == (VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT));
    REQUIRE(plan.heaps.size() == 1);
    CHECK(plan.resources[a.resource].offset == plan.resources[c.resource].offset);
    CHECK(plan.resources[a.resource].offset != plan.resources[b.resource].offset);
    CHECK(plan.heaps[0].size == 1024 + 1000);
    CHECK(plan.resources[target.resource].heap == graph::none);
    CHECK(test::find_hazards(graph, plan, std::vector<graph::MemoryRequirement>(4, {1000, 256, 1})).empty());
    options.alias = false;
    CHECK(graph::compile(graph, options).heaps[0].size == 2 * 1024 + 1000);
}

TEST_CASE("the picture of a frame shows groups, what they hand on and what was culled, with names escaped") {
    graph::Graph graph;
    auto target = imported_target(graph, "the \"target\"");
    auto a = graph.create_image("a", {kColour, 64, 64});
    auto draw = graph.add_pass("draw", PassKind::graphics);
    a = draw.colour_attachment(a, kClear);
    auto compose = graph.add_pass("compose", PassKind::graphics);
    compose.input_attachment(a);
    target = compose.colour_attachment(target, kClear);
    auto measure = graph.add_pass("measure", PassKind::compute);
    measure.sampled(target);
    measure.side_effect();
    graph.add_pass("idle", PassKind::compute);
    const std::string dot = graph::export_graph(graph, graph::compile(graph), graph::ExportFormat::dot);
    CHECK_THAT(dot, Contains("label=\"0: render pass 64 x 64, 2 attachments\\n2 barriers before\""));
    CHECK_THAT(dot, Contains("pass0 -> pass1 [label=\"a\", style=dashed]"));
    CHECK_THAT(dot, Contains("pass1 -> pass2 [label=\"the \\\"target\\\"\"]"));
    CHECK_THAT(dot,
               Contains("pass3 [label=\"idle\", fillcolor=grey, tooltip=\"pass 'idle' is culled: it writes nothing"));

    const std::string declared = graph::export_graph(graph, graph::ExportFormat::dot);
    CHECK_THAT(declared, Contains("pass3 [label=\"idle\", fillcolor=palegreen]"));
    CHECK_THAT(declared, !Contains("cluster"));

    const std::string mermaid = graph::export_graph(graph, graph::compile(graph), graph::ExportFormat::mermaid);
    CHECK_THAT(mermaid, Contains("subgraph group0[\"0: render pass 64 x 64, 2 attachments; 2 barriers before\"]"));
    CHECK_THAT(mermaid, Contains("pass0 -.->|\"a\"| pass1"));
    CHECK_THAT(mermaid, Contains("pass1 -->|\"the #quot;target#quot;\"| pass2"));
    CHECK_THAT(mermaid, Contains("pass3[\"idle\"]:::culled"));

    const std::string json = graph::export_graph(graph, graph::compile(graph), graph::ExportFormat::json);
    CHECK_THAT(json, Contains("\"name\": \"the \\\"target\\\"\""));
    CHECK_THAT(json, Contains("\"culled\": \"pass 'idle' is culled"));
    CHECK_THAT(json, Contains("\"new_layout\": \"ColorAttachmentOptimal\""));
    CHECK_THAT(graph::export_graph(graph, graph::ExportFormat::json), !Contains("\"plan\""));

    CHECK(graph::export_format_of("a/b.mmd") == graph::ExportFormat::mermaid);
    CHECK_FALSE(graph::export_format_of("b.svg"));
}

TEST_CASE("what a kept pass reads of the last frame is made in this one, and lies in memory of its own") {
    graph::Graph graph;
    auto target = imported_target(graph, "target");
    const graph::ImageHistory used = graph.create_history_image("used", {kColour, 64, 64}, {});
    const graph::ImageHistory idle = graph.create_history_image("idle", {kColour, 64, 64}, {});
    auto make = graph.add_pass("make", PassKind::graphics);
    make.colour_attachment(used.current, kClear);
    auto feed = graph.add_pass("feed itself", PassKind::graphics);
    feed.sampled(idle.previous);
    feed.colour_attachment(idle.current, kClear);
    auto show = graph.add_pass("show", PassKind::graphics);
    show.sampled(used.previous);
    target = show.colour_attachment(target, kClear);
    graph::CompileOptions options;
    uint32_t asked = 0;
    options.memory = [&](uint32_t, const graph::PlannedResource&) {
        ++asked;
        return graph::MemoryRequirement{};
    };
    const graph::Plan plan = graph::compile(graph, options);
    CHECK(plan.order == std::vector<uint32_t>{0, 2});
    REQUIRE(plan.culled.size() == 1);
    CHECK(plan.culled[0].pass == 1);
    CHECK(asked == 0);
    CHECK(plan.resources[used.previous.resource].initial_layout == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const graph::Attachment& made = plan.attachments[0];
    CHECK(made.resource == used.current.resource);
    CHECK(made.store == VK_ATTACHMENT_STORE_OP_STORE);
}
