// The hybrid looks as true as the triangles it replaces: both drawn by the engine with one sample a pixel, both held
// against 64 ray-cast samples a pixel of the original mesh.
#include "preprocess/mesh/shapes.h"
#include "tests/reference/comparison.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace splice;
using namespace splice::reference;

namespace {

constexpr std::uint32_t kSize = 512;
constexpr double kMayLose = 0.5;  // dB
// Better than this, losses no longer count: the errors' root mean square is below one level of 8 bits.
constexpr double kGoodEnough = 50;  // dB

void check_truth_of(const std::string& name, const IndexedMesh& mesh) {
    Renderer renderer{RendererOptions{}};
    const BakedModel hybrid = bake_for(renderer, mesh, {});
    const BakedModel triangles = bake_for(renderer, mesh, {}, ForcedRepresentation::kTriangles);
    const Scene hybrid_scene = scene_of(hybrid.on_device), triangle_scene = scene_of(triangles.on_device);
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.camera = frame_camera(hybrid_scene.bounds(), {}, kSize, kSize);

    const ReferenceScene oracle(mesh);
    const bool two_sided = (hybrid.model.info.flags & format::kTwoSided) != 0;
    const Truth truth = truth_of(oracle, mesh, hybrid_scene, settings.camera, kSize, kSize, two_sided);
    const Frame frame = renderer.render(hybrid_scene, settings);
    const Agreement ours = compare(frame, truth), theirs = compare(renderer.render(triangle_scene, settings), truth);
    INFO(name << ": hybrid " << ours.inside_db << " dB, triangles " << theirs.inside_db << " dB");
    CHECK(ours.inside_db >= std::min(theirs.inside_db - kMayLose, kGoodEnough));
    CHECK(ours.iou > 0.97);
    if (ours.inside_db < std::min(theirs.inside_db - kMayLose, kGoodEnough)) {
        write_png(test::artefact(name + "-hybrid.png"), colours(frame));
        write_png(test::artefact(name + "-hybrid-error.png"), difference(colours(frame), truth.image));
    }
}

}  // namespace

namespace {

/// What several samples a pixel gain over one.
struct Gain {
    Agreement once, several;
    std::uint64_t holes = 0;  // pixels 2 px inside that several samples do not cover wholly
};

Gain gain_of(const IndexedMesh& mesh, std::uint32_t antialias, Backend backend) {
    Renderer renderer{RendererOptions{}};
    const BakedModel hybrid = bake_for(renderer, mesh, {});
    const Scene scene = scene_of(hybrid.on_device);
    CaptureSettings settings;
    settings.width = settings.height = kSize / 2;
    settings.camera = frame_camera(scene.bounds(), {}, settings.width, settings.height);
    settings.backend = backend;
    const ReferenceScene oracle(mesh);
    const bool two_sided = (hybrid.model.info.flags & format::kTwoSided) != 0;
    const Truth truth = truth_of(oracle, mesh, scene, settings.camera, settings.width, settings.height, two_sided);
    Gain gain;
    gain.once = compare(renderer.render(scene, settings), truth);
    settings.antialias = antialias;
    const Frame frame = renderer.render(scene, settings);
    gain.several = compare(frame, truth);
    const Mask inside = eroded(truth.coverage, 2);
    for (std::size_t i = 0; i < inside.pixels.size(); ++i)
        gain.holes += inside.pixels[i] != 0 && frame.coverage[i] != 255 ? 1 : 0;
    return gain;
}

}  // namespace

TEST_CASE("a mesh is framed alike whatever represents it") {
    RepairReport report;
    const IndexedMesh mesh = repair_mesh(shapes::bumpy_sphere(2000), RepairOptions{}, report, "shape");
    Renderer renderer{RendererOptions{}};
    const BakedModel triangles = bake_for(renderer, mesh, {}, ForcedRepresentation::kTriangles);
    const BakedModel surfels = bake_for(renderer, mesh, {}, ForcedRepresentation::kSurfels);
    const Box box = scene_of(triangles.on_device).bounds(), other = scene_of(surfels.on_device).bounds();
    CHECK(box.minimum == other.minimum);
    CHECK(box.maximum == other.maximum);
    // Disks overhang the surface, and clip planes must hold them.
    const Box drawn = scene_of(surfels.on_device).drawn_bounds();
    CHECK(drawn.minimum.x < box.minimum.x);
    CHECK(drawn.maximum.z > box.maximum.z);
}

TEST_CASE("several samples a pixel make outlines truer and lose nothing inside") {
    RepairReport report;
    const IndexedMesh sphere = repair_mesh(shapes::bumpy_sphere(100000), RepairOptions{}, report, "shape");
    const IndexedMesh part = repair_mesh(shapes::machined_part(64), RepairOptions{}, report, "shape");
    for (const Backend backend : {Backend::kSprite, Backend::kTile})
        for (const auto& [mesh, least] : {std::pair{&sphere, 6.0}, std::pair{&part, 3.0}}) {
            const Gain gain = gain_of(*mesh, 3, backend);
            INFO(name_of(backend) << ": frame " << gain.once.frame_db << " dB, then " << gain.several.frame_db
                                  << ", inside " << gain.once.inside_db << ", then " << gain.several.inside_db);
            CHECK(gain.several.frame_db > gain.once.frame_db + least);
            CHECK(gain.several.inside_db > gain.once.inside_db);
            CHECK(gain.several.iou > gain.once.iou - 0.001);
            CHECK(gain.holes == 0);
        }
}

TEST_CASE("the thesis's models lose at most half a decibel") {
    for (const char* name : {"bones", "cow", "dragon-50000", "bunny", "crater"}) {
        const auto path = test::model_file(std::string("meshes/") + name + ".smf");
        if (path) check_truth_of(name, load_mesh(*path));
    }
}

TEST_CASE("a bumpy sphere loses at most half a decibel") {
    RepairReport report;
    check_truth_of("bumpy-sphere", repair_mesh(shapes::bumpy_sphere(100000), RepairOptions{}, report, "shape"));
}
