// The view of boxes: which nodes' are shown, and that their edges are where projection says.
#include "engine/capture/capture.h"
#include "engine/scene/node_boxes.h"
#include "preprocess/build_model/build_model.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 160;

// A slanted sheet of triangles on the left, one of disks on the right: an octree of a root and two leaves.
Model two_sheets() {
    HandmadeModel handmade(true);
    handmade.add_triangles(quad({-0.9f, -0.5f, -0.4f}, {0.7f, 0.1f, 0.5f}, {0, 0.9f, -0.2f}));
    handmade.add_surfels(sheet({0.1f, -0.5f, 0.3f}, {0.7f, 0.1f, -0.6f}, {0, 0.9f, 0.1f}, 20));
    Model model = handmade.model();
    model.octree[0].first_child = 1;
    model.octree[0].child_count = 2;
    for (std::uint32_t i = 0; i < 2; ++i) {
        format::OctreeNode leaf{};
        std::copy_n(model.patches[i].bounds_min, 3, leaf.bounds_min);
        std::copy_n(model.patches[i].bounds_max, 3, leaf.bounds_max);
        leaf.first_patch = i;
        leaf.patch_count = 1;
        model.octree.push_back(leaf);
    }
    return model;
}

std::vector<std::array<glm::dvec3, 2>> edges_of(const format::OctreeNode& node) {
    std::vector<std::array<glm::dvec3, 2>> edges;
    const auto corner = [&](int bits) {
        return glm::dvec3((bits & 1) != 0 ? node.bounds_max[0] : node.bounds_min[0],
                          (bits & 2) != 0 ? node.bounds_max[1] : node.bounds_min[1],
                          (bits & 4) != 0 ? node.bounds_max[2] : node.bounds_min[2]);
    };
    for (int bits = 0; bits < 8; ++bits)
        for (const int axis : {1, 2, 4})
            if ((bits & axis) == 0) edges.push_back({corner(bits), corner(bits | axis)});
    return edges;
}

// Level 2 of colour.glsl, as the picture holds it.
bool is_green(const Frame& frame, std::size_t pixel) {
    const std::uint8_t* p = &frame.rgba[4 * pixel];
    return p[0] == 69 && p[1] == 247 && p[2] == 69;
}

CaptureSettings boxes_from(const Camera& camera) {
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.view = View::kBoxes;
    settings.camera = camera;
    settings.clip_to_scene = false;
    settings.want_depth = true;
    return settings;
}

Camera from_the_front(double distance) {
    Camera camera = looking_down_z(0.05);
    camera.eye = {0.2, 0.4, distance};
    camera.target = {0, 0, 0};
    return camera;
}

struct EdgePixels {
    std::size_t shown = 0, missing = 0, hidden = 0, wrongly_shown = 0, elsewhere = 0;
};

// What the picture has of the edges of a model's leaves.
EdgePixels compare(const Frame& frame, const Camera& camera, const Model& model) {
    enum Expected : std::uint8_t { kNothing, kHidden, kNear, kShown };
    std::vector<Expected> expected(frame.coverage.size(), kNothing);
    constexpr double kDepthSlack = 0.03;
    for (std::size_t leaf = 1; leaf < model.octree.size(); ++leaf)
        for (const auto& [from, to] : edges_of(model.octree[leaf]))
            for (int step = 0; step <= 4000; ++step) {
                const glm::dvec3 p = project(camera, kSize, kSize, glm::mix(from, to, step / 4000.0));
                if (p.z < camera.near_plane) continue;
                for (int y = static_cast<int>(p.y) - 2; y <= static_cast<int>(p.y) + 2; ++y)
                    for (int x = static_cast<int>(p.x) - 2; x <= static_cast<int>(p.x) + 2; ++x) {
                        if (x < 0 || y < 0 || x >= static_cast<int>(kSize) || y >= static_cast<int>(kSize)) continue;
                        const double distance = std::hypot(x + 0.5 - p.x, y + 0.5 - p.y);
                        if (distance > 1.2) continue;
                        const auto pixel = static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x);
                        const auto surface = static_cast<double>(frame.depth[pixel]);
                        const Expected here = p.z > surface + kDepthSlack                     ? kHidden
                                              : distance < 0.4 && p.z < surface - kDepthSlack ? kShown
                                                                                              : kNear;
                        expected[pixel] = std::max(expected[pixel], here);
                    }
            }
    EdgePixels result;
    for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) {
        const bool green = is_green(frame, pixel);
        result.shown += expected[pixel] == kShown && green;
        result.missing += expected[pixel] == kShown && !green;
        result.hidden += expected[pixel] == kHidden && !green;
        result.wrongly_shown += expected[pixel] == kHidden && green;
        result.elsewhere += expected[pixel] == kNothing && green;
    }
    return result;
}

}  // namespace

TEST_CASE("edges of boxes are where projection says, and hidden by what is before them") {
    const Model model = two_sheets();
    Renderer renderer({.validate = true});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    for (const Backend backend : {Backend::kSprite, Backend::kTile, Backend::kAuto})
        for (const bool orthographic : {false, true}) {
            const Camera camera = orthographic ? parallel(from_the_front(2.5)) : from_the_front(2.5);
            CaptureSettings settings = boxes_from(camera);
            settings.backend = backend;
            const EdgePixels pixels = compare(renderer.render(scene, settings), camera, model);
            CAPTURE(static_cast<int>(backend), orthographic);
            CHECK(pixels.shown > 400);
            CHECK(pixels.missing == 0);
            CHECK(pixels.hidden > 50);
            CHECK(pixels.wrongly_shown == 0);
            CHECK(pixels.elsewhere == 0);
        }
    CHECK(renderer.validation_messages() == std::vector<std::string>{});
}

TEST_CASE("edges that pass the eye are drawn as far as they are before it") {
    const Model model = two_sheets();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    // Within the right one's box, before its disks, towards a corner.
    Camera camera = looking_down_z(0.05);
    camera.eye = {0.4, -0.1, 0.25};
    camera.target = {0.8, -0.4, 0.4};
    const EdgePixels pixels = compare(renderer.render(scene, boxes_from(camera)), camera, model);
    CHECK(pixels.shown > 20);
    CHECK(pixels.missing == 0);
    CHECK(pixels.elsewhere == 0);
}

TEST_CASE("edges keep a pixel's width with several samples a pixel") {
    const Model model = two_sheets();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = boxes_from(from_the_front(2.5));
    const auto green = [&](std::uint32_t antialias) {
        settings.antialias = antialias;
        const Frame frame = renderer.render(scene, settings);
        double sum = 0;
        // Grey and white have as much red as green.
        for (std::size_t i = 0; i < frame.rgba.size(); i += 4) {
            const auto linear = [](std::uint8_t level) { return std::pow(level / 255.0, 2.2); };
            sum += linear(frame.rgba[i + 1]) - linear(frame.rgba[i]);
        }
        return sum;
    };
    const double one = green(1);
    CHECK(one > 300);
    CHECK(green(4) == Approx(one).epsilon(0.1));
}

TEST_CASE("nodes with nothing that is drawn have no box") {
    const Model model = two_sheets();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = boxes_from(from_the_front(2.5));
    settings.draw_triangles = false;
    const Frame frame = renderer.render(scene, settings);
    std::size_t left = 0, right = 0;
    for (std::size_t pixel = 0; pixel < frame.coverage.size(); ++pixel)
        (pixel % kSize < kSize / 2 ? left : right) += is_green(frame, pixel);
    CHECK(left == 0);
    CHECK(right > 200);
}

namespace {

struct Cloud {
    Model model;
    PointHierarchy hierarchy;
};

Cloud lumpy_cloud() {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    PointCloud points;
    points.source_points = 20'000;
    for (std::size_t i = 0; i < points.source_points; ++i) {
        const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
        points.offsets.push_back((1 + 0.08f * std::sin(7 * n.x()) * std::sin(6 * n.y())) * n);
    }
    BakeStats stats;
    Cloud cloud{build_cloud_model(points, {}, stats), {}};
    cloud.hierarchy = point_hierarchy(unpack_point_tree(cloud.model.point_tree), cloud.model.patches, 0.1f);
    return cloud;
}

// Of a model whose box is one unit long, from the front.
LodCut cut_of(const Cloud& cloud, const PatchView& seen, const glm::dmat4& to_view, double tau) {
    return cut_points(cloud.hierarchy, {.model_to_view = to_view,
                                        .pixel_scale = seen.pixel_scale(),
                                        .half_x = seen.half_x(),
                                        .half_y = seen.half_y(),
                                        .two_sided = true,
                                        .tau = tau,
                                        .triangle_costs = {},
                                        .left_out = {}});
}

bool holds(const NodeBox& box, const format::Surfel& surfel) {
    for (int axis = 0; axis < 3; ++axis)
        if (surfel.position[axis] < box.low[axis] || surfel.position[axis] > box.high[axis]) return false;
    return true;
}

}  // namespace

TEST_CASE("boxes of a cut hold what it draws, and nothing that it leaves out") {
    const Cloud cloud = lumpy_cloud();
    const Camera camera = looking_down_z();
    for (const double aside : {0.0, 0.4}) {
        glm::dmat4 to_view(1.0);
        to_view[3] = {aside, 0, -1.2, 1};
        const PatchView seen(camera, 400, 400, to_view, 1);
        for (const double tau : {1e-6, 6.0, 40.0}) {
            const LodCut cut = cut_of(cloud, seen, to_view, tau);
            const DrawnNodes drawn{.octree = {}, .hierarchy = cloud.hierarchy, .groups = {}, .patches = {}, .cut = cut};
            const std::vector<NodeBox> all = node_boxes(drawn, seen, 1e-9), few = node_boxes(drawn, seen, 60);
            CAPTURE(aside, tau, all.size(), few.size());
            // All ellipses are inner nodes or leaves; surfels are drawn of leaves.
            if (cut.statistics.surfels == 0) CHECK(all.size() == cut.statistics.ellipses);
            CHECK(few.size() <= all.size());
            if (tau < 40) CHECK(few.size() < all.size() / 2);
            std::vector<format::Surfel> surfels;
            for (const CutRun& run : cut.runs) {
                const std::uint32_t last = run.first + run.count - 1;
                const std::uint32_t first = run.inner ? cloud.hierarchy.first_surfel[run.first] : run.first;
                const std::uint32_t end =
                    run.inner ? cloud.hierarchy.first_surfel[last] + cloud.hierarchy.surfel_counts[last] : last + 1;
                for (std::uint32_t i = first; i < end; ++i)
                    surfels.push_back(view_of(cloud.model).surfel(i));
            }
            REQUIRE(surfels.size() > 1000);
            for (const std::vector<NodeBox>* boxes : {&all, &few}) {
                std::size_t outside = 0, needless = 0;
                for (std::size_t i = 0; i < surfels.size(); i += 17)
                    outside += std::none_of(boxes->begin(), boxes->end(),
                                            [&](const NodeBox& box) { return holds(box, surfels[i]); });
                for (std::size_t i = 0; i < boxes->size(); i += boxes->size() / 100 + 1)
                    needless += std::none_of(surfels.begin(), surfels.end(),
                                             [&](const format::Surfel& surfel) { return holds((*boxes)[i], surfel); });
                CHECK(outside == 0);
                CHECK(needless == 0);
            }
        }
    }
}

TEST_CASE("a node that many patches are drawn by has one box, of its depth") {
    const Model model = two_sheets();
    const glm::dmat4 to_view(1.0);
    const Camera camera = from_the_front(2.5);
    const PatchView seen(camera, 400, 400, to_view, 1);
    const PointHierarchy none;
    const LodCut no_cut;
    const std::vector<bool> root{true, false, false}, left{false, true, false}, right_patch{false, true},
        no_patch{false, false};
    const auto levels = [&](const std::vector<bool>& groups, const std::vector<bool>& patches) {
        std::vector<std::uint32_t> result;
        for (const NodeBox& box : node_boxes(
                 {.octree = model.octree, .hierarchy = none, .groups = groups, .patches = patches, .cut = no_cut}, seen,
                 80))
            result.push_back(box.level);
        return result;
    };
    CHECK(levels(root, no_patch) == std::vector<std::uint32_t>{1});
    CHECK(levels(left, right_patch) == std::vector<std::uint32_t>{2, 2});
    CHECK(levels({}, right_patch) == std::vector<std::uint32_t>{2});
    CHECK(levels({}, no_patch).empty());
}
