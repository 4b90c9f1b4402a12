// No hole, nothing lost, no growth: frames of hybrid models held against ray casting of the meshes they were baked
// from. `splice-bench holes` does the same over whole collections and from more sides.
#include "preprocess/mesh/shapes.h"
#include "tests/reference/comparison.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

using namespace splice;
using namespace splice::reference;

namespace {
namespace fs = std::filesystem;

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), RepairOptions{}, report, "shape");
}

struct Look {
    std::uint32_t size = 256;    // pixels a side
    std::size_t directions = 6;  // of the 26, evenly picked
    bool orthographic = false;
    ForcedRepresentation representation = ForcedRepresentation::kHybrid;
};

/// Leaves a picture of the faults behind where there are any.
void check_surface_of(const std::string& name, const IndexedMesh& mesh, const Look& look) {
    Renderer renderer{RendererOptions{}};
    const ReferenceScene oracle(mesh);
    const BakedModel baked = bake_for(renderer, mesh, {}, look.representation);
    const Scene scene = scene_of(baked.on_device);
    const std::vector<glm::dvec3> all = view_directions();
    std::uint64_t inside = 0;  // a plate has no inside from its edge
    for (std::size_t i = 0; i < look.directions; ++i) {
        CaptureSettings settings;
        settings.width = settings.height = look.size;
        settings.camera =
            camera_from(scene.bounds(), all[i * all.size() / look.directions], look.size, look.size, look.orthographic);
        const SurfaceCheck check = check_frame(renderer, scene, view_of(baked.model), oracle, mesh, settings);
        INFO(name << " from direction " << i * all.size() / look.directions << " of 26");
        inside += check.report.inside;
        CHECK(check.report.holes == 0);
        CHECK(check.report.lost == 0);
        CHECK(check.report.grown == 0);
        CHECK(check.report.in_front == 0);
        CHECK(check.iou > 0.9);
        if (!check.report.clean())
            write_png(test::artefact(name + "-" + std::to_string(i) + "-holes.png"), check.marked);
    }
    CHECK(inside > 0);
}

void check_model(const std::string& file, const Look& look) {
    const auto path = test::model_file(file);
    if (path) check_surface_of(path->stem().string(), load_mesh(*path), look);
}

}  // namespace

TEST_CASE("the cube shows no hole and keeps its outline") {
    check_surface_of("cube", repaired(shapes::cube(4)), {});
    check_surface_of("cube-surfels", repaired(shapes::cube(4)), {.representation = ForcedRepresentation::kSurfels});
}

TEST_CASE("the bumpy sphere shows no hole, in perspective and in parallel projection") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(20000));
    check_surface_of("bumpy-sphere", mesh, {});
    check_surface_of("bumpy-sphere-orthographic", mesh, {.directions = 4, .orthographic = true});
}

TEST_CASE("a thin torus knot of surfels alone shows no hole") {
    check_surface_of("torus-knot", repaired(shapes::torus_knot(2, 3, 400, 24)),
                     {.representation = ForcedRepresentation::kSurfels});
}

TEST_CASE("the machined part keeps its sharp edges and its bore") {
    check_surface_of("machined-part", repaired(shapes::machined_part(64)), {});
    check_surface_of("machined-part-surfels", repaired(shapes::machined_part(64)),
                     {.representation = ForcedRepresentation::kSurfels});
}

TEST_CASE("an open terrain shows no hole from either side") {
    check_surface_of("terrain", repaired(shapes::terrain(128)), {.directions = 8});
}

TEST_CASE("Debian's bunny shows no hole") {
    const fs::path bunny = "/usr/share/glmark2/models/bunny.obj";
    REQUIRE(fs::exists(bunny));  // package glmark2-data
    check_surface_of("bunny-obj", load_mesh(bunny), {.size = 512, .directions = 4});
}

TEST_CASE("the thesis's models show no hole") {
    for (const char* name : {"bones", "cow", "dragon-50000", "bunny", "crater"})
        check_model(std::string("meshes/") + name + ".smf", {.size = 512, .directions = 3});
}

// Seen from +z: the rims of its bores, where a flat ring of triangles meets the cut disks of the wall. Rasterisers move
// corners by a fraction of a pixel; between the moved edge and the cut, pixels showed neither.
TEST_CASE("cut disks leave no crack to the triangles that they meet") {
    check_model("meshes/featuretype.STL", {.size = 512, .directions = 2});
}

// Minutes: run by name, test_surface "[.long]", or of one mesh, test_surface "[.long]" -c cow.smf; splice-bench holes
// prints the same as a table.
TEST_CASE("every mesh of the collection shows no hole from 26 directions", "[.long]") {
    const auto folder = test::model_file("meshes");
    if (!folder) return;
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(*folder))
        if (entry.path().string().find(".tif") == std::string::npos) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names)
        DYNAMIC_SECTION(name) {
            check_model("meshes/" + name, {.size = 512, .directions = 26});
        }
}
