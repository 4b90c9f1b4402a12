// Cells that are gathered in segments have pipelines of their own, which are made when a frame has such cells.
#include "engine/capture/capture.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

using namespace splice;
using namespace splice::test;

namespace {

bool has_pass(const Frame& frame, const std::string& name) {
    return std::ranges::any_of(frame.stats.passes, [&](const PassTime& pass) { return pass.name == name; });
}

// 40,000 disks are 625 groups, more than a cell may have for one go; seen from `distance` away.
struct Wall {
    Wall() { model.add_surfels(sheet({-1, -0.8f, -2}, {2, 0, 0}, {0, 1.6f, 0}, 200, kRed)); }
    CaptureSettings seen_from(double distance) const {
        CaptureSettings settings;
        settings.width = settings.height = 128;
        settings.camera = looking_down_z();
        settings.camera.eye.z = distance;
        settings.backend = Backend::kTile;
        settings.merge_px = 0;  // or from afar there would be no full cells
        return settings;
    }
    HandmadeModel model;
};

}  // namespace

TEST_CASE("a frame without full cells does without their pipelines") {
    Wall wall;
    Renderer renderer({.validate = true});
    const Scene scene = scene_of(renderer.load(view_of(wall.model.model())));
    const Frame first = renderer.render(scene, wall.seen_from(0));
    CHECK(has_pass(first, "tile_counts"));
    CHECK(!has_pass(first, "tile_segments"));

    // The first frame with full cells has them, and so have those that come after it.
    const Frame full = renderer.render(scene, wall.seen_from(100));
    CHECK(has_pass(full, "tile_segments"));
    CHECK(std::ranges::count_if(full.coverage, [](std::uint8_t share) { return share > 0; }) > 0);
    const Frame later = renderer.render(scene, wall.seen_from(0));
    CHECK(has_pass(later, "tile_segments"));
    CHECK(!has_pass(later, "tile_counts"));
    CHECK(later.rgba == first.rgba);
    CHECK(renderer.validation_messages() == std::vector<std::string>{});
}

TEST_CASE("full cells look the same, whether their pipelines were made for the frame or before") {
    Wall wall;
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(wall.model.model())));
    const Frame frame = renderer.render(scene, wall.seen_from(100));
    CHECK(frame.rgba == renderer.render(scene, wall.seen_from(100)).rgba);
}

TEST_CASE("pipelines that are made ahead of the first frame are those it uses, or are not missed") {
    Wall wall;
    for (const Shading shading : {Shading::kSurfel, Shading::kDeferred}) {
        Renderer plain({}), ahead({.validate = true});
        CaptureSettings expected = wall.seen_from(0), settings = expected;
        settings.shading = shading;
        ahead.make_for(expected, Lighting{});
        const Frame frame = ahead.render(scene_of(ahead.load(view_of(wall.model.model()))), settings);
        CHECK(frame.rgba == plain.render(scene_of(plain.load(view_of(wall.model.model()))), settings).rgba);
        CHECK(ahead.validation_messages() == std::vector<std::string>{});
    }
    // A renderer may go while they are being made.
    Renderer brief({});
    brief.make_for(wall.seen_from(0), Lighting{});
}
