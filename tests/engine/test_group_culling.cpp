// Groups of surfels that the host keeps from setup: the same bytes with them and without.
#include "engine/bench/bumpy_sphere.h"
#include "engine/capture/capture.h"
#include "preprocess/build_model/build_model.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/mesh_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

struct Found {
    std::uint64_t culled = 0, certain = 0;
};

Found check_bytes(Renderer& renderer, const Scene& scene, CaptureSettings settings) {
    Found found;
    for (const Backend backend : {Backend::kTile, Backend::kRaster, Backend::kPoint}) {
        settings.backend = backend;
        settings.cull_groups = false;
        const Frame all = renderer.render(scene, settings);
        CHECK(all.stats.setup.culled_surfels == 0);
        settings.cull_groups = true;
        const Frame culled = renderer.render(scene, settings);
        const SetupCounts& counts = culled.stats.setup;
        CAPTURE(name_of(backend), counts.surfels, counts.culled_surfels, counts.certain_groups);
        CHECK(counts.surfels + counts.culled_surfels == all.stats.setup.surfels);
        CHECK(culled.rgba == all.rgba);
        found.culled += counts.culled_surfels;
        found.certain += counts.certain_groups;
    }
    return found;
}

CaptureSettings settings_of(const Camera& camera) {
    CaptureSettings settings;
    settings.width = 203;
    settings.height = 150;
    settings.camera = camera;
    return settings;
}

// From the front and far off, with most of it outside the picture, from within, along the surface.
std::vector<Camera> cameras_around(double radius) {
    std::vector<Camera> cameras;
    for (const glm::dvec3 eye : {glm::dvec3(0, 0, 2.5), {0.3, 0.2, 9}, {1.1, 0.1, 0.2}, {0, 0, 0}, {0, 1.02, 0.4}}) {
        Camera camera;
        camera.fov_y_degrees = 60;
        camera.eye = radius * eye;
        camera.target = radius * glm::dvec3(0.1, 0.2, -0.4);
        cameras.push_back(camera);
        cameras.push_back(parallel(camera, 1.7 * radius));
    }
    return cameras;
}

}  // namespace

TEST_CASE("groups of surfels that none is seen of change no byte: flat disks, all and merged") {
    Renderer renderer({});
    for (const double depth : {2.4, 10.0}) {
        const Scene scene = scene_of(renderer.load(view_of(bench::bumpy_sphere(60'000, depth))));
        for (const Camera& camera : cameras_around(1)) {
            CAPTURE(depth, camera.eye.x, camera.eye.y, camera.eye.z, camera.orthographic);
            CaptureSettings settings = settings_of(camera);
            const Found found = check_bytes(renderer, scene, settings);
            CHECK(found.culled > 0);
            if (glm::length(camera.eye) > 2) CHECK(found.certain > 0);
            settings.sides = Sides::kTwoSided;
            check_bytes(renderer, scene, settings);
        }
    }
}

TEST_CASE("groups of surfels that none is seen of change no byte: a mesh's solids, turned, in several instances") {
    Renderer renderer({});
    const auto model = renderer.load(view_of(mesh_model()));
    Scene scene;
    scene.instances = {{model, {}},
                       {model,
                        {.scale = 0.3,
                         .rotation = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1)),
                         .translation = {0.9, 0.3, 1.2}}}};
    std::uint64_t culled = 0;
    for (const Camera& camera : cameras_around(1)) {
        CAPTURE(camera.eye.x, camera.eye.y, camera.eye.z, camera.orthographic);
        for (const Shading shading : {Shading::kSurfel, Shading::kDeferred}) {
            CaptureSettings settings = settings_of(camera);
            settings.shading = shading;
            culled += check_bytes(renderer, scene, settings).culled;
        }
    }
    CHECK(culled > 0);
}

TEST_CASE("groups of surfels that none is seen of change no byte: packed surfels and a cut's ellipses") {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    PointCloud cloud;
    cloud.source_points = 30'000;
    for (std::size_t i = 0; i < cloud.source_points; ++i) {
        const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
        cloud.offsets.push_back((1 + 0.08f * std::sin(7 * n.x()) * std::sin(6 * n.y())) * n);
        cloud.colours.push_back(std::sin(20 * n.z()) > 0 ? 0xff3060e0u : 0xffe0d0a0u);
    }
    BakeStats stats;
    const Model model = build_cloud_model(std::move(cloud), {}, stats);
    REQUIRE(view_of(model).is_packed());
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    std::uint64_t culled = 0;
    for (const Camera& camera : cameras_around(1))
        for (const double tau : {0.0, 1.0})
            for (const Sides sides : {Sides::kOneSided, Sides::kTwoSided}) {
                CAPTURE(camera.eye.x, camera.eye.y, camera.eye.z, camera.orthographic, tau, name_of(sides));
                CaptureSettings settings = settings_of(camera);
                settings.tau = tau;
                settings.sides = sides;
                culled += check_bytes(renderer, scene, settings).culled;
            }
    CHECK(culled > 0);
}

TEST_CASE("runs of a level's triangles that none is seen of change no byte") {
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(mesh_model())));
    std::uint64_t left_out = 0, groups = 0;
    for (const Camera& camera : cameras_around(2))
        for (const double tau : {1.0, 4.0})
            for (const Sides sides : {Sides::kOneSided, Sides::kTwoSided}) {
                CAPTURE(camera.eye.x, camera.eye.y, camera.eye.z, camera.orthographic, tau, name_of(sides));
                CaptureSettings settings = settings_of(camera);
                settings.tau = tau;
                settings.sides = sides;
                settings.shown = Shown::kTriangles;
                settings.cull_groups = false;
                const Frame all = renderer.render(scene, settings);
                settings.cull_groups = true;
                const Frame culled = renderer.render(scene, settings);
                CHECK(culled.rgba == all.rgba);
                groups += all.stats.cut.counts.groups_by_triangles;
                left_out += all.stats.triangles_drawn - culled.stats.triangles_drawn;
            }
    CHECK(groups > 0);
    CHECK(left_out > 1000);
}
