// A checker is worth what it catches: mistakes of every kind, made on purpose wherever a plan of a random frame has
// room for them.
#include "engine/render_graph/compile.h"
#include "tests/render_graph/hazard_checker.h"
#include "tests/render_graph/random_graph.h"

#include <catch2/catch.hpp>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace splice;
using graph::none;
using graph::Plan;

struct Frame {
    graph::Graph graph;
    std::vector<graph::MemoryRequirement> memory;
    Plan plan;
};

std::unique_ptr<Frame> frame_of(uint32_t seed) {
    auto frame = std::make_unique<Frame>();
    test::declare_random(frame->graph, test::random_tape(120 + seed % 7 * 40, seed));
    frame->memory = test::random_sizes(frame->graph, seed);
    graph::CompileOptions options;
    options.max_input_attachments = 16;
    options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return frame->memory[resource]; };
    frame->plan = graph::compile(frame->graph, options);
    return frame;
}

/// How many mistakes of a kind were made and how many found.
struct Score {
    uint32_t made = 0, caught = 0;
};

class Mutator {
  public:
    Mutator(const Frame& frame, std::map<std::string, Score>& scores)
        : frame_(frame), plan_(frame.plan), scores_(scores) {}

    void run() {
        remove_barriers();
        spoil_barriers();
        spoil_attachments();
        spoil_render_passes();
        spoil_resources();
        move_resources();
        spoil_heaps();
    }

  private:
    template <typename Change>
    void make(const std::string& mistake, const Change& change) {
        Plan mutant = plan_;
        change(mutant);
        Score& score = scores_[mistake];
        ++score.made;
        score.caught += test::find_hazards(frame_.graph, mutant, frame_.memory).empty() ? 0 : 1;
    }

    void remove_barriers() {
        const auto remove = [&](graph::Range graph::BarrierBatch::*range, auto barriers, const char* mistake) {
            for (size_t group = 0; group <= plan_.groups.size(); ++group) {
                const auto batch = [&](auto& plan) -> auto& {
                    return group < plan.groups.size() ? plan.groups[group].barriers : plan.final_barriers;
                };
                const graph::Range here = batch(plan_).*range;
                for (uint32_t i = 0; i < here.count; ++i) {
                    make(mistake, [&](Plan& mutant) {
                        std::swap((mutant.*barriers)[here.first + i], (mutant.*barriers)[here.first + here.count - 1]);
                        --(batch(mutant).*range).count;
                    });
                }
            }
        };
        remove(&graph::BarrierBatch::images, &Plan::image_barriers, "no image barrier");
        remove(&graph::BarrierBatch::buffers, &Plan::buffer_barriers, "no buffer barrier");
    }

    void spoil_barriers() {
        for (size_t i = 0; i < plan_.image_barriers.size(); ++i) {
            const graph::ImageBarrier& barrier = plan_.image_barriers[i];
            if (barrier.source.stages != 0)
                make("waits for no stage", [&](Plan& mutant) { mutant.image_barriers[i].source.stages = 0; });
            if (barrier.source.access != 0)
                make("makes nothing available", [&](Plan& mutant) { mutant.image_barriers[i].source.access = 0; });
            if (barrier.destination.access != 0)
                make("makes nothing visible", [&](Plan& mutant) { mutant.image_barriers[i].destination.access = 0; });
            make("to another layout", [&](Plan& mutant) {
                mutant.image_barriers[i].new_layout = barrier.new_layout == VK_IMAGE_LAYOUT_GENERAL
                                                          ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                                                          : VK_IMAGE_LAYOUT_GENERAL;
            });
            if (barrier.old_layout != barrier.new_layout) {
                make("from another layout",
                     [&](Plan& mutant) { mutant.image_barriers[i].old_layout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR; });
            }
        }
        for (size_t i = 0; i < plan_.buffer_barriers.size(); ++i) {
            const graph::BufferBarrier& barrier = plan_.buffer_barriers[i];
            if (barrier.source.stages != 0)
                make("waits for no stage", [&](Plan& mutant) { mutant.buffer_barriers[i].source.stages = 0; });
            if (barrier.source.access == 0) continue;  // only waits: nothing to flush, nothing to see
            make("makes nothing available", [&](Plan& mutant) { mutant.buffer_barriers[i].source.access = 0; });
            make("makes nothing visible", [&](Plan& mutant) { mutant.buffer_barriers[i].destination.access = 0; });
        }
        for (size_t i = 0; i < plan_.dependencies.size(); ++i) {
            make("a subpass waits for no stage", [&](Plan& mutant) { mutant.dependencies[i].source_scope.stages = 0; });
        }
    }

    void spoil_attachments() {
        for (size_t i = 0; i < plan_.attachments.size(); ++i) {
            const graph::Attachment& attachment = plan_.attachments[i];
            const auto spoil = [&](const char* mistake, const auto& change) {
                make(mistake, [&](Plan& mutant) { change(mutant.attachments[i]); });
            };
            const auto forget_load = [](graph::Attachment& a) { a.load = VK_ATTACHMENT_LOAD_OP_DONT_CARE; };
            if (attachment.load == VK_ATTACHMENT_LOAD_OP_LOAD) spoil("load lost", forget_load);
            if (attachment.load == VK_ATTACHMENT_LOAD_OP_CLEAR) {
                spoil("clear lost", forget_load);
                spoil("clear value lost", [](graph::Attachment& a) { a.clear_access = none; });
            }
            if (attachment.load == VK_ATTACHMENT_LOAD_OP_DONT_CARE)
                spoil("nothing is loaded", [](graph::Attachment& a) { a.load = VK_ATTACHMENT_LOAD_OP_LOAD; });
            if (attachment.stencil_load != VK_ATTACHMENT_LOAD_OP_DONT_CARE)
                spoil("stencil load lost",
                      [](graph::Attachment& a) { a.stencil_load = VK_ATTACHMENT_LOAD_OP_DONT_CARE; });
            if (attachment.store == VK_ATTACHMENT_STORE_OP_STORE) {
                spoil("store lost", [](graph::Attachment& a) { a.store = VK_ATTACHMENT_STORE_OP_DONT_CARE; });
                spoil("written and not touched", [](graph::Attachment& a) {
                    a.store = VK_ATTACHMENT_STORE_OP_NONE;
                    if (a.stencil_store == VK_ATTACHMENT_STORE_OP_STORE) a.stencil_store = a.store;
                });
            }
            if (attachment.stencil_store == VK_ATTACHMENT_STORE_OP_STORE)
                spoil("stencil store lost",
                      [](graph::Attachment& a) { a.stencil_store = VK_ATTACHMENT_STORE_OP_DONT_CARE; });
            spoil("left in another layout", [](graph::Attachment& a) { a.final_layout = VK_IMAGE_LAYOUT_GENERAL; });
        }
        for (size_t i = 0; i < plan_.references.size(); ++i) {
            if (plan_.references[i].aspects != 0)
                make("an input without aspects", [&](Plan& mutant) { mutant.references[i].aspects = 0; });
        }
    }

    void spoil_render_passes() {
        for (size_t i = 0; i < plan_.render_passes.size(); ++i) {
            make("other layers", [&](Plan& mutant) { mutant.render_passes[i].layers = 7; });
            make("other samples", [&](Plan& mutant) { mutant.render_passes[i].samples = VK_SAMPLE_COUNT_4_BIT; });
            make("other size", [&](Plan& mutant) { ++mutant.render_passes[i].height; });
        }
    }

    void spoil_resources() {
        for (size_t i = 0; i < plan_.resources.size(); ++i) {
            const graph::PlannedResource& planned = plan_.resources[i];
            if (planned.lifetime.first_group == none) continue;
            const auto spoil = [&](const char* mistake, const auto& change) {
                make(mistake, [&](Plan& mutant) { change(mutant.resources[i]); });
            };
            if (planned.image_usage != 0)
                spoil("no image usage", [](graph::PlannedResource& resource) { resource.image_usage = 0; });
            if (planned.buffer_usage != 0)
                spoil("no buffer usage", [](graph::PlannedResource& resource) { resource.buffer_usage = 0; });
            if (!planned.memoryless)
                spoil("wrongly without memory", [](graph::PlannedResource& resource) { resource.memoryless = true; });
            if (planned.heap == none) continue;
            spoil("misaligned", [](graph::PlannedResource& resource) { ++resource.offset; });
            spoil("not placed", [](graph::PlannedResource& resource) { resource.heap = none; });
        }
    }

    bool overlap(const Plan& plan, size_t a, size_t b) const {
        const graph::PlannedResource &x = plan.resources[a], &y = plan.resources[b];
        return x.heap == y.heap && x.offset < y.offset + y.size && y.offset < x.offset + x.size;
    }

    /// By one step of alignment, and onto the last step of another: the bytes that are shared are few.
    void move_resources() {
        for (size_t i = 0; i < plan_.resources.size(); ++i) {
            if (plan_.resources[i].heap == none) continue;
            const uint64_t step = frame_.memory[i].alignment;
            std::vector<uint64_t> places{plan_.resources[i].offset + step, plan_.resources[i].offset - step};
            for (const graph::PlannedResource& other : plan_.resources) {
                if (other.heap == plan_.resources[i].heap)
                    places.push_back((other.offset + other.size - 1) / step * step);
            }
            for (const uint64_t place : places) {
                Plan moved = plan_;
                moved.resources[i].offset = place;
                bool alive = false;
                for (size_t j = 0; j < plan_.resources.size(); ++j) {
                    const graph::Lifetime &a = plan_.resources[i].lifetime, &b = plan_.resources[j].lifetime;
                    const bool together = a.first_group <= b.last_group && b.first_group <= a.last_group;
                    alive = alive || (j != i && plan_.resources[j].heap != none && together && overlap(moved, i, j));
                }
                if (alive) make("moved onto one alive", [&](Plan& mutant) { mutant = moved; });
            }
        }
    }

    void spoil_heaps() {
        for (size_t i = 0; i < plan_.heaps.size(); ++i) {
            make("heap too small", [&](Plan& mutant) { mutant.heaps[i].size /= 2; });
            make("heap of no alignment", [&](Plan& mutant) { mutant.heaps[i].alignment = 1; });
            make("heap of another memory", [&](Plan& mutant) { mutant.heaps[i].memory_type_bits = 8; });
            make("heap of the other kind", [&](Plan& mutant) { mutant.heaps[i].images = !mutant.heaps[i].images; });
        }
    }

    const Frame& frame_;
    const Plan& plan_;
    std::map<std::string, Score>& scores_;
};

}  // namespace

TEST_CASE("the checker catches mistakes of every kind") {
    std::map<std::string, Score> scores;
    for (uint32_t seed = 1; seed <= 60; ++seed) {
        const auto frame = frame_of(seed);
        REQUIRE(test::find_hazards(frame->graph, frame->plan, frame->memory).empty());
        Mutator(*frame, scores).run();
    }
    CHECK(scores.size() == 31);
    for (const auto& [mistake, score] : scores) {
        INFO(mistake << ": " << score.caught << " of " << score.made);
        CHECK(score.made >= 5);
        // What a barrier makes available may have been made so before: by the dependencies of a render pass, or by the
        // barrier of the other half of a history.
        if (mistake == "makes nothing available") {
            CHECK(score.caught > score.made * 9 / 10);
        } else {
            CHECK(score.caught == score.made);
        }
    }
}

TEST_CASE("two results of one pass on the same bytes are caught") {
    const auto share = [](const graph::Graph& graph, uint64_t size) {
        const std::vector<graph::MemoryRequirement> memory(3, {size, 256, 1});
        graph::CompileOptions options;
        options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return memory[resource]; };
        Plan plan = graph::compile(graph, options);
        CHECK(test::find_hazards(graph, plan, memory).empty());
        plan.resources[0].offset = plan.resources[1].offset;
        return test::find_hazards(graph, plan, memory);
    };
    using graph::Contents;
    SECTION("buffers") {
        graph::Graph graph;
        auto counts = graph.create_buffer("counts", {4096});
        auto lists = graph.create_buffer("lists", {4096});
        const auto out = graph.import_buffer("out", {4096}, {.after = graph::external::host_read()});
        auto bin = graph.add_pass("bin", graph::PassKind::compute);
        counts = bin.storage_write(counts, Contents::discard());
        lists = bin.storage_write(lists, Contents::discard());
        auto gather = graph.add_pass("gather", graph::PassKind::compute);
        gather.storage_read(counts);
        gather.storage_read(lists);
        gather.storage_write(out, Contents::discard());
        CHECK_FALSE(share(graph, 4096).empty());
    }
    SECTION("attachments") {
        constexpr graph::ImageDescription description{VK_FORMAT_R8G8B8A8_UNORM, 64, 64};
        graph::Graph graph;
        auto albedo = graph.create_image("albedo", description);
        auto normal = graph.create_image("normal", description);
        const auto out = graph.import_image("picture", description, {.after = graph::external::transfer_read()});
        auto fill = graph.add_pass("g-buffer", graph::PassKind::graphics);
        albedo = fill.colour_attachment(albedo, Contents::clear({}));
        normal = fill.colour_attachment(normal, Contents::clear({}));
        auto light = graph.add_pass("light", graph::PassKind::graphics);
        light.sampled(albedo);
        light.sampled(normal);
        light.colour_attachment(out, Contents::discard());
        CHECK_FALSE(share(graph, 16384).empty());
    }
}
