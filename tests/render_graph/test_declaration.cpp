// Misuse fails at the declaration (or, where only a complete pass can be judged, in compile()) with the names of pass
// and resource and a way out.
#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"

#include <catch2/catch.hpp>

namespace {

using namespace splice;
using Catch::Contains;
using graph::Contents;
using graph::PassKind;

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT_S8_UINT;

const Contents kClear = Contents::clear(VkClearValue{});

struct Fixture {
    graph::Graph graph;
    graph::ImageHandle colour = graph.create_image("colour", {kColour, 64, 64});
    graph::ImageHandle other = graph.create_image("other", {kColour, 64, 64});
    graph::ImageHandle small = graph.create_image("small", {kColour, 32, 64});
    graph::ImageHandle depth = graph.create_image("depth", {kDepth, 64, 64});
    graph::BufferHandle buffer = graph.create_buffer("list", {1024});
};

}  // namespace

TEST_CASE_METHOD(Fixture, "reading before anything is written names pass, resource and the fix") {
    graph::Pass pass = graph.add_pass("blur", PassKind::compute);
    CHECK_THROWS_WITH(pass.sampled(colour),
                      Contains("pass 'blur'") && Contains("image 'colour'") && Contains("add the writing pass before"));
    CHECK_THROWS_WITH(pass.storage_read(buffer), Contains("pass 'blur'") && Contains("buffer 'list'"));
    CHECK_THROWS_WITH(pass.storage_read_write(buffer), Contains("clear or discard"));
    graph::Pass draw = graph.add_pass("draw", PassKind::graphics);
    CHECK_THROWS_WITH(draw.colour_attachment(colour, Contents::keep()), Contains("clear or discard"));
}

TEST_CASE_METHOD(Fixture, "a stale handle is refused and the pass that wrote since is named") {
    graph::Pass first = graph.add_pass("first", PassKind::graphics);
    const graph::ImageHandle drawn = first.colour_attachment(colour, kClear);
    CHECK(drawn.version == 1);
    graph::Pass second = graph.add_pass("second", PassKind::graphics);
    CHECK_THROWS_WITH(second.colour_attachment(colour, kClear),
                      Contains("pass 'second'") && Contains("image 'colour'") && Contains("stale handle") &&
                          Contains("pass 'first'") && Contains("the last write returned"));
    second.colour_attachment(drawn, Contents::keep());
    graph::Pass third = graph.add_pass("third", PassKind::compute);
    CHECK_THROWS_WITH(third.sampled(drawn), Contains("pass 'second' has written it"));
}

TEST_CASE_METHOD(Fixture, "a pass that reads what it writes is a feedback loop") {
    graph::Pass fill = graph.add_pass("fill", PassKind::graphics);
    colour = fill.colour_attachment(colour, kClear);
    depth = fill.depth_stencil_attachment(depth, kClear);
    graph::Pass pass = graph.add_pass("loop", PassKind::graphics);
    pass.input_attachment(colour);
    CHECK_THROWS_WITH(pass.colour_attachment(colour, Contents::keep()),
                      Contains("pass 'loop'") && Contains("image 'colour'") && Contains("feedback loop") &&
                          Contains("an input attachment and a colour attachment"));
    depth = pass.depth_stencil_attachment(depth, Contents::keep());
    CHECK_THROWS_WITH(pass.input_attachment(depth), Contains("feedback loop"));
    CHECK_THROWS_WITH(pass.sampled(depth), Contains("feedback loop"));
}

TEST_CASE_METHOD(Fixture, "depth may be tested, sampled and read as an input by one pass, in one layout") {
    graph::Pass fill = graph.add_pass("fill", PassKind::graphics);
    depth = fill.depth_stencil_attachment(depth, kClear);
    colour = fill.colour_attachment(colour, kClear);
    graph::Pass pass = graph.add_pass("read", PassKind::graphics);
    pass.depth_stencil_read(depth);
    pass.input_attachment(depth);
    pass.sampled(depth);
    CHECK_THROWS_WITH(pass.depth_stencil_read(depth),
                      Contains("one depth-stencil attachment at most") && Contains("split the pass"));
    graph::Pass compute = graph.add_pass("compute", PassKind::compute);
    compute.sampled(colour);
    CHECK_THROWS_WITH(compute.storage_read(colour), Contains("different layouts"));
}

TEST_CASE_METHOD(Fixture, "formats that cannot be used that way are refused") {
    graph::Pass pass = graph.add_pass("draw", PassKind::graphics);
    CHECK_THROWS_WITH(pass.colour_attachment(depth, kClear),
                      Contains("image 'depth'") && Contains("has depth") && Contains("create it with a colour format"));
    CHECK_THROWS_WITH(pass.depth_stencil_attachment(colour, kClear), Contains("image 'colour'") &&
                                                                         Contains("no depth") &&
                                                                         Contains("create it with a format that has"));
    graph::Pass compute = graph.add_pass("compute", PassKind::compute);
    CHECK_THROWS_WITH(compute.storage_write(depth, Contents::discard()), Contains("pass 'compute'"));
}

TEST_CASE_METHOD(Fixture, "a pass can only do what its kind can") {
    graph::Pass compute = graph.add_pass("cull", PassKind::compute);
    CHECK_THROWS_WITH(
        compute.colour_attachment(colour, kClear),
        Contains("pass 'cull', image 'colour': a compute pass cannot use a colour attachment; use it in a "
                 "graphics pass"));
    CHECK_THROWS_WITH(compute.storage_write(buffer, Contents::discard(), VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT),
                      Contains("shader stages that a compute pass does not have; name its own"));
    CHECK_THROWS_WITH(compute.transfer_write(buffer, Contents::discard()), Contains("target of a transfer"));
    CHECK_THROWS_WITH(compute.vertex_buffer(buffer), Contains("a vertex buffer"));
    graph::Pass transfer = graph.add_pass("copy", PassKind::transfer);
    CHECK_THROWS_WITH(transfer.storage_write(buffer, Contents::discard()), Contains("a transfer pass cannot use"));
    CHECK_THROWS_WITH(transfer.transfer_write(colour, kClear), Contains("only attachments can be cleared"));
}

TEST_CASE_METHOD(Fixture, "handles of another graph and passes that are complete are refused") {
    graph::Pass early = graph.add_pass("early", PassKind::graphics);
    graph::Pass late = graph.add_pass("late", PassKind::graphics);
    CHECK_THROWS_WITH(early.colour_attachment(colour, kClear), Contains("pass 'early'") && Contains("is complete"));
    CHECK_THROWS_WITH(early.side_effect(), Contains("is complete"));
    CHECK_THROWS_WITH(late.colour_attachment({99, 0, graph.id()}, kClear), Contains("no image of this graph"));
    CHECK_THROWS_WITH(late.colour_attachment({buffer.resource, 0, graph.id()}, kClear),
                      Contains("no image of this graph"));
    CHECK_THROWS_WITH(late.vertex_buffer({colour.resource, 0, graph.id()}), Contains("no buffer of this graph"));
    // A resource of the same kind, place and version, but another one's.
    graph::Graph another;
    const graph::ImageHandle theirs = another.create_image("theirs", {kColour, 64, 64});
    CHECK(theirs.resource == colour.resource);
    CHECK_THROWS_WITH(late.colour_attachment(theirs, kClear),
                      Contains("pass 'late'") && Contains("no image of this graph"));
}

TEST_CASE_METHOD(Fixture, "handles and passes from before clear() are refused") {
    graph::Pass old = graph.add_pass("old", PassKind::graphics);
    graph.clear();
    CHECK_THROWS_WITH(old.side_effect(), Contains("pass 0") && Contains("was cleared") && Contains("add it anew"));
    const graph::ImageHandle anew = graph.create_image("new", {kColour, 64, 64});
    CHECK(anew.resource == colour.resource);
    graph::Pass pass = graph.add_pass("new", PassKind::graphics);
    CHECK_THROWS_WITH(old.colour_attachment(anew, kClear), Contains("was cleared"));
    CHECK_THROWS_WITH(old.record({}), Contains("was cleared"));
    CHECK_THROWS_WITH(pass.colour_attachment(colour, kClear), Contains("since it was last cleared"));
    const graph::ImageHandle drawn = pass.colour_attachment(anew, kClear);
    CHECK(drawn == graph.image(anew.resource));
}

TEST_CASE_METHOD(Fixture, "a refused access leaves the graph as it was") {
    graph::Pass pass = graph.add_pass("draw", PassKind::graphics);
    CHECK_THROWS_AS(pass.input_attachment(colour), graph::GraphError);
    CHECK(graph.accesses(0).empty());
    colour = pass.colour_attachment(colour, kClear);
    CHECK(graph.accesses(0).size() == 1);
    CHECK_NOTHROW(graph::compile(graph));
}

TEST_CASE("resources without extent are refused by name") {
    graph::Graph graph;
    CHECK_THROWS_WITH(graph.create_image("empty", {kColour, 0, 4}), Contains("image 'empty'"));
    CHECK_THROWS_WITH(graph.create_image("formless", {VK_FORMAT_UNDEFINED, 4, 4}), Contains("image 'formless'"));
    CHECK_THROWS_WITH(graph.create_buffer("none", {0}), Contains("buffer 'none'"));
}

TEST_CASE_METHOD(Fixture, "attachments of different size or samples in one pass are refused by compile()") {
    graph::Pass pass = graph.add_pass("draw", PassKind::graphics);
    pass.colour_attachment(colour, kClear);
    SECTION("size") {
        pass.colour_attachment(small, kClear);
        CHECK_THROWS_WITH(graph::compile(graph),
                          Contains("pass 'draw', image 'small': is 32 x 64") && Contains("image 'colour' is 64 x 64"));
    }
    SECTION("samples") {
        graph::ImageDescription description{kDepth, 64, 64};
        description.samples = VK_SAMPLE_COUNT_4_BIT;
        graph.clear();
        colour = graph.create_image("colour", {kColour, 64, 64});
        const graph::ImageHandle sampled = graph.create_image("samples", description);
        graph::Pass again = graph.add_pass("draw", PassKind::graphics);
        again.colour_attachment(colour, kClear);
        again.depth_stencil_attachment(sampled, kClear);
        CHECK_THROWS_WITH(graph::compile(graph), Contains("pass 'draw', image 'samples'") && Contains("samples"));
    }
    SECTION("levels") {
        graph::ImageDescription description{kColour, 64, 64};
        description.mip_levels = 4;
        graph.clear();
        const graph::ImageHandle mipped = graph.create_image("mipped", description);
        graph::Pass again = graph.add_pass("draw", PassKind::graphics);
        again.colour_attachment(mipped, kClear);
        CHECK_THROWS_WITH(graph::compile(graph), Contains("pass 'draw', image 'mipped'") && Contains("one level"));
    }
}

TEST_CASE("more attachments than the device allows are refused by compile()") {
    graph::Graph graph;
    std::vector<graph::ImageHandle> images;
    for (int i = 0; i < 5; ++i)
        images.push_back(graph.create_image("image" + std::to_string(i), {kColour, 8, 8}));
    graph::Pass write = graph.add_pass("write", PassKind::graphics);
    for (graph::ImageHandle& image : images)
        image = write.colour_attachment(image, kClear);
    graph::CompileOptions options;
    options.max_colour_attachments = 4;
    CHECK_THROWS_WITH(graph::compile(graph, options), Contains("pass 'write', image 'image4': too many colour"));
    options.max_colour_attachments = 5;
    CHECK_NOTHROW(graph::compile(graph, options));
    graph::Pass read = graph.add_pass("read", PassKind::graphics);
    for (const graph::ImageHandle image : images)
        read.input_attachment(image);
    CHECK_THROWS_WITH(graph::compile(graph, options), Contains("pass 'read', image 'image4': too many input"));
}

TEST_CASE("a graphics pass without an attachment has no area") {
    graph::Graph graph;
    graph.add_pass("nothing", PassKind::graphics).side_effect();
    CHECK_THROWS_WITH(graph::compile(graph), Contains("pass 'nothing'") && Contains("attachment"));
}

TEST_CASE_METHOD(Fixture, "a cycle cannot be declared: contents can only be named once they are written") {
    graph::Pass first = graph.add_pass("first", PassKind::graphics);
    const graph::ImageHandle later{other.resource, 1,
                                   graph.id()};  // what the second pass is going to make of the first's output
    CHECK_THROWS_WITH(first.sampled(later), Contains("pass 'first', image 'other': no pass has written these contents "
                                                     "yet; add the writing pass before"));
    colour = first.colour_attachment(colour, kClear);
    graph::Pass second = graph.add_pass("second", PassKind::graphics);
    second.sampled(colour);
    CHECK(second.colour_attachment(other, kClear) == later);
    CHECK_THROWS_WITH(first.sampled(later), Contains("pass 'first': is complete"));
}

TEST_CASE("of a history the last frame is only read, and this frame is written if the last is read") {
    graph::Graph graph;
    const graph::ImageHistory history = graph.create_history_image("light", {kColour, 64, 64}, {});
    graph::Pass draw = graph.add_pass("draw", PassKind::graphics);
    CHECK_THROWS_WITH(draw.colour_attachment(history.previous, Contents::keep()),
                      Contains("pass 'draw', image 'light of the last frame': is only read; write the current half"));
    CHECK_THROWS_WITH(draw.sampled(history.current), Contains("image 'light': is read before"));
    draw.input_attachment(history.previous);
    draw.side_effect();
    CHECK_THROWS_WITH(graph::compile(graph),
                      Contains("pass 'draw', image 'light of the last frame': is read, but no "
                               "pass writes what the next frame will read; write image 'light'"));
    graph::Pass make = graph.add_pass("make", PassKind::graphics);
    make.colour_attachment(history.current, kClear);
    CHECK_NOTHROW(graph::compile(graph));
}
