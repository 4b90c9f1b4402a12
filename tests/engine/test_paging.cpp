// Models that are larger than the memory they may take.
#include "engine/capture/capture.h"
#include "engine/scene/surfel_pager.h"
#include "preprocess/build_model/build_model.h"
#include "tests/engine/frame_holes.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <fstream>
#include <random>

using namespace splice;

namespace {

constexpr std::uint64_t kBlock = SurfelPager::kBlockBytes;

// A bumpy ball with stripes.
Model ball(std::size_t count) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    PointCloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
        cloud.offsets.push_back((1 + 0.08f * std::sin(7 * n.x()) * std::sin(6 * n.y())) * n);
        cloud.colours.push_back(std::sin(20 * n.z()) > 0 ? 0xff3060e0u : 0xffe0d0a0u);
    }
    BakeStats stats;
    return build_cloud_model(std::move(cloud), {}, stats);
}

struct Subject {
    explicit Subject(std::size_t points) { write_model(view_of(ball(points)), folder / "ball.splice"); }

    Scene load(Renderer& renderer, std::uint64_t limit) const {
        const auto file = std::make_shared<const ModelFile>(folder / "ball.splice");
        return scene_of(renderer.load(
            file->view(), {.limit = limit, .owner = file, .release = [file](auto part) { file->release(part); }}));
    }

    test::TemporaryFolder folder;
};

class RandomCameras {
  public:
    explicit RandomCameras(const Box& bounds) : bounds_(bounds) {}

    // Small steps and now and then a leap, from far away to close up.
    Camera next() {
        if (random_() % 8 == 0) place_ = {number(), number(), number()};
        place_ += 0.2 * glm::dvec3(number(), number(), number());
        Camera camera;
        camera.target = bounds_.centre() + 0.2 * bounds_.radius() * glm::dvec3(number(), number(), number());
        const double distance = bounds_.radius() * std::exp2(1.5 * number() + 1.3);
        camera.eye = camera.target + distance * glm::normalize(place_ + glm::dvec3(1e-3));
        camera.fov_y_degrees = 45;
        return camera;
    }

  private:
    double number() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

    Box bounds_;
    std::mt19937 random_{11};
    glm::dvec3 place_{0, 0, 1};
};

std::uint64_t resident_bytes() {
    std::ifstream statistics("/proc/self/statm");
    std::uint64_t pages = 0;
    statistics >> pages >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void fly_through(std::size_t points, int frames) {
    const Subject subject(points);
    const std::uint64_t limit = 2 * kBlock;
    REQUIRE(points * 16 > 2 * limit);
    Renderer renderer({});
    const Scene whole = subject.load(renderer, ~std::uint64_t{0}), paged = subject.load(renderer, limit);
    RandomCameras cameras(whole.bounds());
    CaptureSettings settings;
    settings.width = settings.height = 128;
    settings.backend = Backend::kTile;
    std::uint64_t incomplete = 0, complete = 0, resident_half_way = 0;
    for (int i = 0; i < frames; ++i) {
        CAPTURE(i);
        if (i == frames / 2) resident_half_way = resident_bytes();
        settings.camera = cameras.next();
        settings.tau = 6 * (i % 3);
        settings.wait_for_data = i % 4 == 0;
        settings.view = i % 5 == 0 ? View::kLevels : View::kShaded;
        const Frame full = renderer.render(whole, settings), part = renderer.render(paged, settings);
        CHECK(test::holes(full, part) == 0);
        CHECK(full.stats.pages.limit_bytes == 0);
        CHECK(part.stats.pages.limit_bytes == limit);
        CHECK(part.stats.pages.resident_bytes <= limit);
        const bool all = part.stats.pages.missing_surfels == 0;
        (all ? complete : incomplete) += 1;
        if (all) CHECK(part.rgba == full.rgba);
        if (!settings.wait_for_data) continue;
        const Frame again = renderer.render(paged, settings);
        CHECK(again.rgba == part.rgba);
    }
    CHECK(incomplete > 0);
    CHECK(complete > 0);
    // Shaders and buffers of some megabytes are still made in a short flight. In a long one a few kilobytes that every
    // frame kept would be more.
    CHECK(resident_bytes() < resident_half_way + (std::uint64_t{32} << 20));
}

}  // namespace

TEST_CASE(
    "a random flight over a model larger than its limit shows no hole, repeats where it waits and keeps to the limit") {
    fly_through(80'000, 40);
}

TEST_CASE("a random flight of some twenty minutes over a model larger than its limit", "[.long]") {
    fly_through(200'000, 12'000);
}
