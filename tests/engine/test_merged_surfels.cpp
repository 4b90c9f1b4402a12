// Splats that stand for several surfels where those fall on a fraction of a pixel: what they hold, and what shows.
#include "engine/bench/bumpy_sphere.h"
#include "engine/capture/capture.h"
#include "engine/metrics/image_metrics.h"
#include "engine/scene/merged_surfels.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/surfel_clip.h"
#include "tests/engine/frame_colours.h"
#include "tests/engine/frame_holes.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/mesh_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace splice;
using namespace splice::test;

namespace {

glm::vec3 centre_of(const format::Surfel& surfel) {
    return {surfel.position[0], surfel.position[1], surfel.position[2]};
}

bool holds(const format::Surfel& outer, const format::Surfel& inner) {
    const float slack = 1e-6f;
    return glm::distance(centre_of(outer), centre_of(inner)) + float_from_half(inner.radius) <=
           float_from_half(outer.radius) + slack;
}

MergedSurfels merged(const Model& model) {
    return merge_surfels(model.surfels, model.patches);
}

}  // namespace

TEST_CASE("every disk is held by one that stands for it, no farther away than it says") {
    const Model model = GENERATE(0, 1) == 0 ? bench::bumpy_sphere(20'000, 2.4) : mesh_model();
    const MergedSurfels all = merged(model);
    REQUIRE(all.levels.size() >= 2);
    std::size_t ranges = 0;
    for (std::size_t level = 0; level < all.levels.size(); ++level) {
        REQUIRE(all.levels[level].size() == model.patches.size());
        for (std::size_t p = 0; p < model.patches.size(); ++p) {
            const MergedRange& range = all.levels[level][p];
            if (range.count == 0) continue;
            ++ranges;
            const format::Patch& patch = model.patches[p];
            const auto finer = std::span(model.surfels).subspan(patch.first_surfel, patch.surfel_count);
            const auto coarser = std::span(all.records).subspan(range.first, range.count);
            CHECK(coarser.size() < finer.size());
            for (const format::Surfel& surfel : finer) {
                CHECK(surfel.patch == coarser.front().patch);
                REQUIRE(std::ranges::any_of(coarser, [&](const format::Surfel& disk) {
                    return holds(disk, surfel) &&
                           glm::distance(centre_of(disk), centre_of(surfel)) <= range.growth + 1e-6f;
                }));
            }
            const float largest = patch.max_surfel_radius + range.growth + 1e-6f;
            for (const format::Surfel& disk : coarser)
                CHECK(float_from_half(disk.radius) <= largest);
        }
    }
    CHECK(ranges > 10);
}

TEST_CASE("disks that a line cuts stay, and so do disks that face different ways") {
    std::vector<Disk> disks = sheet({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 16);
    HandmadeModel plain, cut, folded;
    plain.add_surfels(disks);
    for (std::size_t i = 0; i < disks.size(); i += 2)
        disks[i].clip = encode_clip(0, 0.5f);
    cut.add_surfels(disks);
    for (std::size_t i = 0; i < disks.size(); ++i) {
        disks[i].clip = kNoClip;
        disks[i].normal = i % 2 == 0 ? glm::vec3(0.7f, 0, 0.7f) : glm::vec3(-0.7f, 0, 0.7f);
    }
    folded.add_surfels(disks);
    CHECK(!merged(plain.model()).records.empty());
    CHECK(merged(cut.model()).records.empty());
    CHECK(merged(folded.model()).records.empty());
}

TEST_CASE("the two sides of a thin wall, and disks without a size, stay") {
    std::vector<Disk> wall, points;
    for (int i = 0; i < 64; ++i) {
        const float x = static_cast<float>(i / 2) * 0.1f, side = i % 2 == 0 ? 1.0f : -1.0f;
        wall.push_back({{x, 0, 0.001f * side}, {0, 0, side}, 0.08f, 0.01f, 0xffffffffu});
        points.push_back({{x + 0.001f * side, 0, 0}, {0, 0, 1}, 0, 0.01f, 0xffffffffu});
    }
    HandmadeModel walls, specks;
    walls.add_surfels(wall);
    specks.add_surfels(points);
    CHECK(merged(walls.model()).records.empty());
    CHECK(merged(specks.model()).records.empty());
}

TEST_CASE("a small disk within a large one counts as one that grows") {
    std::vector<Disk> disks;
    for (int i = 0; i < 64; ++i) {
        const bool small = i % 2 != 0;
        disks.push_back({{static_cast<float>(i / 2) * 0.5f + (small ? 0.001f : 0.0f), 0, 0},
                         {0, 0, 1},
                         small ? 0.01f : 0.2f,
                         0.01f,
                         small ? 0xffffffffu : 0xff000000u});
    }
    HandmadeModel model;
    model.add_surfels(disks);
    const MergedSurfels all = merged(model.model());
    for (const std::vector<MergedRange>& level : all.levels)
        CHECK((level.front().count == 0 || level.front().growth >= 0.19f));
}

TEST_CASE("colours and normals of merged surfels are means") {
    const glm::vec3 tilted = glm::normalize(glm::vec3(0.2f, 0, 1));
    HandmadeModel model;
    // A row of pairs, white and black, tilted to either side.
    std::vector<Disk> disks;
    for (int i = 0; i < 64; ++i) {
        const float x = static_cast<float>(i / 2) * 0.1f + static_cast<float>(i % 2) * 0.01f;
        const bool odd = i % 2 != 0;
        disks.push_back(
            {{x, 0, 0}, odd ? tilted : tilted * glm::vec3(-1, 1, 1), 0.02f, 0.01f, odd ? 0xffffffffu : 0xff000000u});
    }
    model.add_surfels(disks);
    const MergedSurfels all = merged(model.model());
    REQUIRE(!all.levels.empty());
    const MergedRange& range = all.levels.front().front();
    REQUIRE(range.count == 32);
    for (std::uint32_t i = 0; i < range.count; ++i) {
        const format::Surfel& disk = all.records[range.first + i];
        CHECK(int{disk.colour[0]} == 188);  // sRGB of a half
        CHECK(disk.normal == 0);            // octahedral (0, 0, 1)
        CHECK(disk.position[0] == Approx(0.1f * static_cast<float>(i) + 0.005f).margin(1e-5));
    }
}

TEST_CASE("merged surfels leave no hole and are as true from afar, and near nothing changes") {
    const int which = GENERATE(0, 1, 2);
    Renderer renderer({});
    const Scene scene = scene_of(
        renderer.load(view_of(which == 2 ? mesh_model() : bench::bumpy_sphere(100'000, which == 0 ? 2.4 : 10))));
    CaptureSettings settings;
    settings.width = settings.height = 192;
    settings.backend = Backend::kTile;
    CHECK(settings.merge_px == kMergePixels);
    for (const double distance : {2.2, 6.0, 12.0, 40.0}) {
        settings.camera = looking_down_z();
        settings.camera.eye = {0, 0, distance};
        settings.merge_px = 0;
        const Frame full = renderer.render(scene, settings);
        settings.merge_px = distance < 3 ? 0.05 : kMergePixels;
        const Frame fewer = renderer.render(scene, settings);
        const MergedCounts& counts = fewer.stats.merged;
        CAPTURE(which, distance, counts.splats, counts.surfels);
        CHECK(full.stats.merged.splats == 0);
        CHECK(full.stats.surfels_drawn - fewer.stats.surfels_drawn == counts.surfels - counts.splats);
        if (distance < 3) {
            CHECK(counts.splats == 0);
            CHECK(fewer.rgba == full.rgba);
            continue;
        }
        if (distance > 10) CHECK(static_cast<double>(counts.splats) < 0.6 * static_cast<double>(counts.surfels));
        CHECK(holes(full, fewer) == 0);
        // 64 samples a pixel of all surfels.
        settings.merge_px = 0;
        settings.antialias = 8;
        const metrics::ColourImage truth = colours_of(renderer.render(scene, settings));
        settings.antialias = 1;
        const double of_full = metrics::psnr(colours_of(full), truth),
                     of_fewer = metrics::psnr(colours_of(fewer), truth);
        CAPTURE(of_full, of_fewer);
        CHECK(of_fewer > of_full - 0.75);
    }
}

TEST_CASE("a wider picture merges as a view from farther away does, and less towards its corner") {
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(bench::bumpy_sphere(100'000, 2.4))));
    CaptureSettings settings;
    settings.width = settings.height = 256;
    settings.backend = Backend::kTile;
    const auto seen = [&](double distance, double tangent, const glm::dvec3& aside) {
        settings.camera = looking_down_z();
        settings.camera.eye = {0, 0, distance};
        settings.camera.target = settings.camera.eye + glm::dvec3(0, 0, -1) + aside;
        settings.camera.fov_y_degrees = glm::degrees(2 * std::atan(tangent));
        return renderer.render(scene, settings).stats;
    };
    const FrameStats near = seen(3, 0.5, {}), far = seen(18, 0.5, {}), wide = seen(3, 3, {}),
                     corner = seen(3, 3, {1.5, 1.5, 0});
    CHECK(near.merged.splats == 0);
    CHECK(far.merged.surfels > 90'000);
    CHECK(wide.merged.surfels > 60'000);  // parts of it are nearer than its middle by more than from afar
    CHECK(corner.covered_pixels > wide.covered_pixels);
    CHECK(corner.merged.surfels < wide.merged.surfels);
}
