// The baseline of the frame benchmark draws what the sprite backend draws.
#include "engine/bench/bumpy_sphere.h"
#include "engine/bench/frame/bare_sprites.h"

#include <catch2/catch.hpp>

using namespace splice;

TEST_CASE("bare sprites and the sprite backend draw the same picture") {
    const Model sphere = bench::bumpy_sphere(5000, 4);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(sphere)));
    bench::BareSprites bare("auto", sphere);
    CaptureSettings settings;
    settings.camera.eye = {0.2, 0.1, 2.5};
    fit_clip_planes(settings.camera, scene.drawn_bounds());
    for (const std::uint32_t side : {128u, 61u}) {
        settings.width = settings.height = side;
        const Frame frame = renderer.render(scene, settings);
        CHECK(bare.render(settings).surfels_drawn == frame.stats.surfels_drawn);
        const std::vector<std::uint8_t> picture = bare.picture();
        REQUIRE(picture.size() == frame.rgba.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < picture.size(); ++i)
            different += i % 4 != 3 && picture[i] != frame.rgba[i] ? 1 : 0;
        CHECK(different == 0);
        CHECK(frame.stats.covered_pixels > side * side / 5);
    }
}
