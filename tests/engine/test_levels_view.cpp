// The view of levels: every range of triangles is labelled with its level, and every level has its colour.
#include "engine/capture/capture.h"
#include "engine/scene/draw_list.h"
#include "engine/scene/gpu_model.h"
#include "tests/engine/mesh_model.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 160;

// colour.glsl's, in levels of 8 bits.
using Colour = std::array<int, 3>;

double decoded(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
int encoded(double c) {
    return static_cast<int>(std::lround(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

Colour colour_of(std::uint32_t label) {
    const std::uint32_t depth = label & 0xff, number = label >> 8;
    const double fineness = std::pow(0.6, number);
    const std::array<double, 3> brown{0.3, 0.11, 0.03}, shift{0, 2.0 / 3, 1.0 / 3};
    Colour colour{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = depth / 6.0 + shift[i];
        const double ramp = std::clamp(std::abs((turn - std::floor(turn)) * 6 - 3) - 1, 0.0, 1.0);
        const double hue = decoded(0.27 + 0.7 * ramp);
        colour[i] = encoded(depth == 0 ? std::lerp(brown[i], 0.6, fineness) : std::lerp(0.9, hue, fineness));
    }
    return colour;
}

// Depth in the octree of each node, counted from 1.
std::vector<std::uint32_t> depths_of(const std::vector<format::OctreeNode>& octree) {
    std::vector<std::uint32_t> depths(octree.size(), 1);
    for (std::size_t i = 0; i < octree.size(); ++i)
        for (std::uint32_t child = 0; child < octree[i].child_count; ++child)
            depths[octree[i].first_child + child] = depths[i] + 1;
    return depths;
}

// Labels under which what begins at this index of a level may go.
std::set<std::uint32_t> labels_at(const GpuModel& model, std::uint64_t index) {
    std::set<std::uint32_t> labels;
    const auto add = [&](std::uint32_t first_lod, std::uint32_t count, std::uint32_t depth) {
        for (std::uint32_t number = 0; number < count; ++number)
            if (const format::Lod& lod = model.lods()[first_lod + number];
                index >= lod.first_index && index - lod.first_index < lod.index_count)
                labels.insert(number << 8 | depth);
    };
    const std::vector<std::uint32_t> depths = depths_of(model.octree());
    for (std::size_t i = 0; i < depths.size(); ++i)
        add(model.octree()[i].first_lod, model.octree()[i].lod_count, depths[i]);
    for (const format::Patch& patch : model.patches())
        add(patch.first_lod, patch.lod_count, 0);
    return labels;
}

}  // namespace

TEST_CASE("the view of levels tells the levels of triangles apart, of patches and of nodes") {
    Renderer renderer({});
    Scene scene = scene_of(renderer.load(view_of(mesh_model())));
    scene.lighting = {.ambient = glm::dvec3(1), .lights = {}};
    scene.background.colour = glm::dvec3(0);
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.view = View::kLevels;
    settings.shown = Shown::kTriangles;
    settings.clip_to_scene = false;
    settings.camera = frame_camera(scene.bounds(), {}, kSize, kSize);
    fit_clip_planes(settings.camera, scene.drawn_bounds());
    const GpuModel& model = *scene.instances.front().model;
    std::set<std::uint32_t> seen;
    for (const double tau : {0.0, 0.3, 0.6, 1.0, 1.5, 2.0, 4.0, 1000.0}) {
        CAPTURE(tau);
        const DrawList draws = build_draw_list(scene, settings.camera, kSize, kSize,
                                               {.surfels_as_triangles = true, .label_levels = true, .tau = tau});
        std::set<Colour> expected{{0, 0, 0}};
        for (const DrawRange& range : draws.instances.front().triangles) {
            CHECK(labels_at(model, range.first).count(range.patch) == 1);
            expected.insert(colour_of(range.patch));
            seen.insert(range.patch);
        }
        settings.tau = tau;
        const Frame frame = renderer.render(scene, settings);
        std::size_t other = 0;
        std::set<Colour> shown;
        for (std::size_t i = 0; i < frame.rgba.size(); i += 4) {
            const auto found = std::find_if(expected.begin(), expected.end(), [&](const Colour& colour) {
                return std::abs(colour[0] - frame.rgba[i]) <= 1 && std::abs(colour[1] - frame.rgba[i + 1]) <= 1 &&
                       std::abs(colour[2] - frame.rgba[i + 2]) <= 1;
            });
            if (found == expected.end())
                ++other;
            else
                shown.insert(*found);
        }
        CHECK(other == 0);
        // Some may be on the far side alone.
        CHECK(shown.size() >= std::min<std::size_t>(expected.size(), 3) - 1);
        if (tau == 0) CHECK(shown == std::set<Colour>{{0, 0, 0}, {203, 203, 203}});
    }
    const auto has = [&](bool node, bool coarser) {
        return std::any_of(seen.begin(), seen.end(), [&](std::uint32_t label) {
            return ((label & 0xff) != 0) == node && (label >> 8 != 0) == coarser;
        });
    };
    CHECK(has(false, false));
    CHECK(has(false, true));
    CHECK(has(true, false));
    CHECK(has(true, true));
}
