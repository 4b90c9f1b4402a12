// Every switch of the executor changes cost and never the image: frames with dead passes, contents that are
// overwritten, blended over and handed on at the pixel, and many valid orders, painted under every combination of
// switches.
#include "engine/bench/graph/device_graph.h"
#include "engine/bench/graph/measure_device.h"
#include "engine/bench/graph/painter.h"
#include "engine/bench/graph/random.h"
#include "tests/render_graph/device_fixture.h"

#include <catch2/catch.hpp>

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace splice;
using graph::Contents;

constexpr uint32_t kPasses = 26, kSide = 32;
constexpr graph::ImageDescription kLarge{VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide};
constexpr graph::ImageDescription kSmall{VK_FORMAT_R8G8B8A8_UNORM, kSide / 2, kSide / 2};

/// Passes over a pool of images that they read, overwrite and add to at random; two pictures come out.
class Mixture {
  public:
    Mixture(graph::Graph& graph, uint64_t seed, bench::Painter& painter)
        : graph_(graph), random_(seed), painter_(painter) {}

    void declare() {
        for (uint32_t i = 0; i < 10; ++i) {
            const std::string name = "image " + std::to_string(i);
            images_.push_back({graph_.create_image(name, i % 3 == 2 ? kSmall : kLarge), i % 3 == 2, false});
        }
        for (uint32_t pass = 0; pass + 2 < kPasses; ++pass)
            add_pass(pass);
        for (uint32_t i = 0; i < 2; ++i) {
            const graph::ImageHandle picture = graph_.import_image("picture " + std::to_string(i), kLarge,
                                                                   {.after = graph::external::transfer_read()});
            graph::Pass pass = graph_.add_pass("present " + std::to_string(i), graph::PassKind::graphics);
            for (size_t image = i; image < images_.size(); image += 3) {
                if (images_[image].filled) sample(pass, images_[image]);
            }
            pass.colour_attachment(picture, Contents::discard());
            painter_.paint(graph_, pass);
        }
    }

  private:
    struct Image {
        graph::ImageHandle handle;
        bool small, filled;
    };

    static void sample(graph::Pass& pass, const Image& image) {
        pass.sampled(image.handle, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
    }
    uint32_t any_image() { return random_.below(static_cast<uint32_t>(images_.size())); }

    void add_pass(uint32_t number) {
        graph::Pass pass = graph_.add_pass("pass " + std::to_string(number), graph::PassKind::graphics);
        const uint32_t first = any_image(), second = any_image();
        std::set<uint32_t> targets{first};
        if (images_[second].small == images_[first].small && random_.below(3) == 0) targets.insert(second);
        std::set<uint32_t> reads;
        for (uint32_t i = random_.below(4); i > 0; --i)
            reads.insert(any_image());
        for (const uint32_t read : reads) {
            const Image& image = images_[read];
            if (!image.filled || targets.count(read) != 0) continue;
            if (image.small == images_[first].small && random_.below(3) != 0) {
                pass.input_attachment(image.handle);
            } else {
                sample(pass, image);
            }
        }
        for (const uint32_t target : targets) {
            Image& image = images_[target];
            const Contents contents = image.filled && random_.below(2) == 0 ? Contents::keep()
                                      : random_.below(2) == 0 ? Contents::clear(graph::clear_colour(0.5F, 0, 1, 0))
                                                              : Contents::discard();
            image.handle = pass.colour_attachment(image.handle, contents);
            image.filled = true;
        }
        if (random_.below(12) == 0) pass.side_effect();
        painter_.paint(graph_, pass);
    }

    graph::Graph& graph_;
    bench::Random random_;
    bench::Painter& painter_;
    std::vector<Image> images_;
};

}  // namespace

TEST_CASE("no combination of switches changes what random frames paint") {
    test::ValidatedDevice validated;
    const bench::PassShaders shaders(validated.device);
    for (const uint64_t seed : {1U, 2U}) {
        std::vector<std::byte> expected;
        std::set<std::vector<uint32_t>> orders;
        for (uint32_t bits = 0; bits < 32; ++bits) {
            CAPTURE(seed, bits);
            graph::ExecutorOptions options;
            options.timestamps = false;
            options.cull = (bits & 1) == 0;
            options.merge = (bits & 2) == 0;
            options.alias = (bits & 4) == 0;
            options.batch_barriers = (bits & 8) == 0;
            if ((bits & 16) != 0) options.random_order = seed * 100 + bits;
            bench::Painter painter(validated.device, shaders, 1);
            bench::DeviceGraph frame(
                validated.device, [&](graph::Graph& graph) { Mixture(graph, seed, painter).declare(); }, options);
            for (int again = 0; again < 2; ++again) {
                validated.device.submit_and_wait([&](VkCommandBuffer commands) { frame.record(commands); });
                const std::vector<std::byte> bytes = frame.results();
                if (expected.empty()) {
                    expected = bytes;
                    // Two pictures of one colour each, which every pass that leads there has changed.
                    CHECK(std::set<std::byte>(bytes.begin(), bytes.end()).size() > 5);
                }
                CHECK(bytes == expected);
            }
            // The frames have what the switches are about.
            const graph::Plan& plan = frame.executor().plan();
            CHECK(plan.order.size() + plan.culled.size() == kPasses);
            CHECK(plan.culled.empty() != options.cull);
            if (bits == 0) CHECK(plan.render_passes.size() < plan.order.size());
            if (options.random_order) orders.insert(plan.order);
        }
        CHECK(orders.size() >= 8);
    }
    CHECK(validated.complaints() == "");
}
