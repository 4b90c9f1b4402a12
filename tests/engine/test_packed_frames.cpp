// Packed surfels on screen: shaders read what the preprocessor packed, in every backend, and packing hardly shows.
#include "engine/capture/capture.h"
#include "engine/metrics/image_metrics.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/surfel_extent.h"
#include "tests/engine/frame_colours.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace splice;

namespace {

constexpr int kSurfels = 6000;

// A sphere of surfels on a spiral, plain, nothing rounded.
Model plain_sphere() {
    Model model;
    format::Patch patch{};
    patch.representation = format::Representation::kSurfels;
    patch.surfel_count = kSurfels;
    patch.lod_count = 1;
    patch.cone_axis[2] = 1;
    patch.cone_cos = -1;
    const float radius = 0.4f, disk = 2.2f * radius / std::sqrt(float{kSurfels});
    for (int i = 0; i < kSurfels; ++i) {
        const double z = 1 - (2 * i + 1.0) / kSurfels, around = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double across = std::sqrt(1 - z * z);
        const float n[3] = {static_cast<float>(across * std::cos(around)),
                            static_cast<float>(across * std::sin(around)), static_cast<float>(z)};
        format::Surfel surfel{};
        for (int axis = 0; axis < 3; ++axis)
            surfel.position[axis] = radius * n[axis];
        surfel.radius = half_at_least(disk);
        const float stored = float_from_half(surfel.radius), swell = 0.03f * stored;
        surfel.extent = encode_extent({0.2f * swell, swell, 1.5f * stored + 1.2f * swell}, stored);
        surfel.normal = encode_octahedral(n[0], n[1], n[2]);
        surfel.colour[0] = static_cast<std::uint8_t>(128 + 120 * std::sin(9 * n[0]));
        surfel.colour[1] = 200;
        surfel.colour[2] = static_cast<std::uint8_t>(128 + 120 * std::cos(7 * n[1]));
        model.surfels.push_back(surfel);
    }
    for (int axis = 0; axis < 3; ++axis) {
        patch.bounds_min[axis] = model.info.bounds_min[axis] = -0.45f;
        patch.bounds_max[axis] = model.info.bounds_max[axis] = 0.45f;
    }
    patch.max_surfel_radius = model.info.max_surfel_radius = 2 * disk;
    patch.max_surfel_epsilon = 4 * disk;
    model.info.source_scale = 1;
    model.info.flags = format::kTwoSided;
    model.patches = {patch};
    model.lods = {{}};
    model.materials = {{0xffffffffu, format::kNoTexture}};
    return model;
}

Model packed(Model model) {
    for (const format::Surfel& surfel : model.surfels)
        model.packed_surfels.push_back(pack_surfel(surfel));
    model.surfels.clear();
    return model;
}

Model unpacked(Model model) {
    const ModelView view = view_of(model);
    std::vector<format::Surfel> surfels;
    for (std::uint64_t i = 0; i < view.surfel_count(); ++i)
        surfels.push_back(view.surfel(i));
    model.packed_surfels.clear();
    model.surfels = std::move(surfels);
    return model;
}

metrics::ColourImage picture(Renderer& renderer, const Model& model, const CaptureSettings& settings) {
    return test::colours_of(renderer.render(scene_of(renderer.load(view_of(model))), settings));
}

}  // namespace

TEST_CASE("every backend draws packed surfels as it draws them unpacked, and packing does not show") {
    Renderer renderer({});
    const Model plain = plain_sphere(), in_half = packed(plain), and_back = unpacked(in_half);
    CaptureSettings settings;
    settings.width = settings.height = 256;
    for (const View view : {View::kShaded, View::kNormals, View::kPatches})
        for (const Backend backend : {Backend::kSprite, Backend::kRaster, Backend::kTile, Backend::kPoint})
            for (const bool quads : {false, true}) {
                CAPTURE(name_of(view), name_of(backend), quads);
                settings.view = view;
                settings.backend = backend;
                settings.force_quads = quads;
                const metrics::ColourImage image = picture(renderer, in_half, settings);
                CHECK(metrics::psnr(image, picture(renderer, and_back, settings)) > 70);
                if (view != View::kPatches) CHECK(metrics::psnr(image, picture(renderer, plain, settings)) > 50);
            }
}

TEST_CASE("a cut gathers packed surfels and ellipses alike") {
    BakeStats stats;
    PointCloud cloud;
    for (const format::Surfel& surfel : plain_sphere().surfels) {
        cloud.offsets.emplace_back(surfel.position[0], surfel.position[1], surfel.position[2]);
        cloud.colours.push_back(std::uint32_t{surfel.colour[0]} | 0xff808000u);
    }
    const Model model = build_cloud_model(std::move(cloud), {}, stats);
    REQUIRE(model.packed_surfels.size() == kSurfels);
    Renderer renderer({});
    CaptureSettings settings;
    settings.width = settings.height = 256;
    for (const double tau : {0.01, 2.0}) {
        settings.tau = tau;
        CHECK(metrics::psnr(picture(renderer, model, settings), picture(renderer, unpacked(model), settings)) > 70);
    }
}
