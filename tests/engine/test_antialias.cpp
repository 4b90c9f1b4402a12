// Several samples a pixel: edges in place, coverage in alpha, light mixed as light.
#include "engine/capture/capture.h"
#include "preprocess/model_format/error.h"
#include "tests/engine/handmade_model.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 64;
constexpr float kPixel = 2.0f / kSize;  // world units

// Parallel rays along -z; the pixel (x, y) holds the point ((x + 0.5) kPixel - 1, 1 - (y + 0.5) kPixel).
CaptureSettings straight_on(std::uint32_t antialias) {
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.camera.eye = {0, 0, 3};
    settings.camera.orthographic = true;
    settings.camera.orthographic_height = 2;
    settings.antialias = antialias;
    return settings;
}

Scene unlit(Renderer& renderer, HandmadeModel& model, bool transparent) {
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    scene.lighting.ambient = glm::dvec3(1);
    scene.lighting.lights.clear();
    scene.background.transparent = transparent;
    return scene;
}

struct Pixel {
    int red, green, blue, alpha;
};

Pixel pixel_at(const Frame& frame, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &frame.rgba[4 * (std::size_t{y} * frame.width + x)];
    return {p[0], p[1], p[2], p[3]};
}

double share_at(const Frame& frame, std::uint32_t x, std::uint32_t y) {
    return frame.coverage[std::size_t{y} * frame.width + x] / 255.0;
}

// A red quad whose right edge lies at `edge` pixels from the left; `lean` moves its upper end by so many.
HandmadeModel with_edge_at(float edge, float lean = 0) {
    const float left = -0.5f, right = edge * kPixel - 1;
    auto corners = quad({left, -0.5f, 0}, {right - left, 0, 0}, {0, 1, 0}, kRed);
    for (Corner& corner : corners)
        if (corner.position.x > left && corner.position.y > 0) corner.position.x += lean * kPixel;
    HandmadeModel model;
    model.add_triangles(corners);
    return model;
}

double encoded(double linear) {
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

}  // namespace

TEST_CASE("an edge within a pixel covers its share of it") {
    Renderer renderer({});
    for (const std::uint32_t antialias : {2u, 3u, 4u, 8u}) {
        for (const float share : {0.1f, 0.3f, 0.55f, 0.9f}) {
            CAPTURE(antialias, share);
            HandmadeModel model = with_edge_at(40 + share);
            const Scene scene = unlit(renderer, model, true);
            const Frame frame = renderer.render(scene, straight_on(antialias));
            CHECK(std::abs(share_at(frame, 40, 32) - share) <= 0.5 / antialias + 0.01);
            CHECK(share_at(frame, 39, 32) == 1);
            CHECK(share_at(frame, 41, 32) == 0);
            // Alpha is that share, and the colour is the surface's, not darkened.
            const Pixel pixel = pixel_at(frame, 40, 32);
            CHECK(pixel.alpha == std::lround(255 * share_at(frame, 40, 32)));
            if (pixel.alpha > 0) CHECK(pixel.red == 255);
            CHECK(pixel.green == 0);
        }
    }
}

TEST_CASE("a leaning edge is in place on average") {
    Renderer renderer({});
    HandmadeModel model = with_edge_at(40.2f, 7.3f);
    const Scene scene = unlit(renderer, model, true);
    const auto area = [&](std::uint32_t antialias) {
        const Frame frame = renderer.render(scene, straight_on(antialias));
        double sum = 0;
        for (std::uint32_t y = 20; y < 44; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x)
                sum += share_at(frame, x, y);
        return sum / 24;
    };
    // Mean width of those rows, which lie around the middle of the edge.
    const double width = 40.2 + 7.3 / 2 - 16;
    CHECK(area(4) == Approx(width).margin(0.05));
    CHECK(area(1) == Approx(width).margin(0.25));
}

TEST_CASE("at an edge, light mixes with the background's light") {
    Renderer renderer({});
    HandmadeModel model = with_edge_at(40.5f);
    Scene scene = unlit(renderer, model, false);
    scene.background.colour = {0, 0.5, 1};
    const Frame frame = renderer.render(scene, straight_on(2));
    REQUIRE(share_at(frame, 40, 32) == Approx(0.5).margin(0.01));
    const Pixel edge = pixel_at(frame, 40, 32), beyond = pixel_at(frame, 45, 32);
    const double background_green = std::pow((0.5 + 0.055) / 1.055, 2.4);
    CHECK(edge.red == Approx(encoded(0.5)).margin(1));
    CHECK(edge.green == Approx(encoded(background_green / 2)).margin(1));
    CHECK(edge.blue == Approx(encoded(0.5)).margin(1));
    CHECK(edge.alpha == 255);
    CHECK(beyond.green == 128);
    CHECK(beyond.red == 0);
}

TEST_CASE("an edge in front of another surface mixes with that surface") {
    Renderer renderer({});
    HandmadeModel model = with_edge_at(40.5f);
    model.add_surfels(sheet({-0.9f, -0.9f, -0.5f}, {1.8f, 0, 0}, {0, 1.8f, 0}, 40, kBlue));
    const Scene scene = unlit(renderer, model, true);
    for (const Backend backend : {Backend::kSprite, Backend::kTile, Backend::kRaster, Backend::kPoint}) {
        CaptureSettings settings = straight_on(2);
        settings.backend = backend;
        const Frame frame = renderer.render(scene, settings);
        const Pixel edge = pixel_at(frame, 40, 32);
        CHECK(edge.red == Approx(encoded(0.5)).margin(1));
        CHECK(edge.blue == Approx(encoded(0.5)).margin(1));
        CHECK(edge.alpha == 255);
    }
}

TEST_CASE("a sheet of surfels is whole inside and partly covers the pixels at its border") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 60, kRed));
    const Scene scene = unlit(renderer, model, true);
    const Frame once = renderer.render(scene, straight_on(1));
    for (const std::uint32_t antialias : {2u, 3u, 5u}) {
        CAPTURE(antialias);
        const Frame frame = renderer.render(scene, straight_on(antialias));
        int whole = 0, partly = 0, strays = 0;
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const double share = share_at(frame, x, y);
                const bool inside = x >= 18 && x < 46 && y >= 18 && y < 46;
                const bool outside = x < 14 || x >= 50 || y < 14 || y >= 50;
                if (inside && (share != 1 || pixel_at(frame, x, y).red != 255)) ++strays;
                if (outside && share != 0) ++strays;
                whole += share == 1 ? 1 : 0;
                partly += share > 0 && share < 1 ? 1 : 0;
            }
        CHECK(strays == 0);
        CHECK(partly > 60);
        CHECK(std::abs(whole + partly / 2.0 - static_cast<double>(once.stats.covered_pixels)) < 80);
        CHECK(frame.stats.antialias == antialias);
        CHECK(renderer.render(scene, straight_on(antialias)).rgba == frame.rgba);
    }
}

TEST_CASE("views of numbers take one sample a pixel whatever is asked for") {
    Renderer renderer({});
    HandmadeModel model = with_edge_at(40.5f);
    const Scene scene = unlit(renderer, model, false);
    for (const View view : {View::kDepth, View::kVisibility, View::kOverlap}) {
        CaptureSettings settings = straight_on(1);
        settings.view = view;
        const Frame once = renderer.render(scene, settings);
        settings.antialias = 4;
        const Frame again = renderer.render(scene, settings);
        CHECK(again.rgba == once.rgba);
        CHECK(again.stats.antialias == 1);
    }
    CaptureSettings settings = straight_on(1);
    settings.want_depth = true;
    const std::vector<float> depth = renderer.render(scene, settings).depth;
    settings.antialias = 3;
    CHECK(renderer.render(scene, settings).depth == depth);
}

TEST_CASE("more samples than the device can draw are refused in one line") {
    Renderer renderer({});
    HandmadeModel model = with_edge_at(40);
    const Scene scene = unlit(renderer, model, false);
    CaptureSettings settings = straight_on(8);
    settings.width = settings.height = 8192;
    CHECK_THROWS_WITH(renderer.render(scene, settings), Catch::Contains("8192x8192") && Catch::Contains("8 samples"));
    settings = straight_on(0);
    CHECK_THROWS_AS(renderer.render(scene, settings), UsageError);
}

// What triangles write are samples already. A surfel that is hidden sends the same frame through all passes.
TEST_CASE("samples of triangles alone are resolved at once, to the same bytes") {
    Renderer renderer({});
    HandmadeModel triangles = with_edge_at(40.3f, 3), hidden;
    hidden.add_surfels({{{-0.2f, 0, -0.5f}, {0, 0, 1}, 0.1f, 0.01f}});
    const auto model = renderer.load(view_of(triangles.model()));
    for (const View view : {View::kShaded, View::kNormals, View::kPatches, View::kWireframe})
        for (const bool transparent : {false, true}) {
            CAPTURE(name_of(view), transparent);
            Scene alone = scene_of(model);
            alone.background.transparent = transparent;
            Scene beside = alone;
            beside.instances.push_back({renderer.load(view_of(hidden.model())), {}});
            CaptureSettings settings = straight_on(3);
            settings.view = view;
            const Frame through = renderer.render(beside, settings), direct = renderer.render(alone, settings);
            CHECK(direct.stats.setup == SetupCounts{});
            CHECK(direct.rgba == through.rgba);
            CHECK(through.stats.surfels_drawn == 1);
            CHECK(through.stats.passes.size() >= direct.stats.passes.size() + (view == View::kNormals ? 0 : 2));
        }
}
