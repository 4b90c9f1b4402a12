// The real models: what the readers make of them, held to the counts of the collection's own description, which were
// measured by another parser.
#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <set>

using namespace splice;
using namespace splice::test;

namespace {

struct Model {
    const char* file;
    std::size_t vertices, faces;  // as the file has them; STL: after welding
    std::uint64_t boundary_edges;
    bool closed;
};

// Boundary edges are listed where welding changes nothing; kWelded where it joins what the file keeps apart.
constexpr std::uint64_t kWelded = ~std::uint64_t{0};

constexpr Model kModels[] = {
    {"meshes/cow.smf", 2904, 5804, 0, true},
    {"meshes/bones.smf", 2154, 4204, 0, true},
    {"meshes/dragon-50000.smf", 25418, 50761, 69, false},
    {"meshes/bunny.smf", 35947, 69451, 223, false},
    {"meshes/crater.smf", 100000, 199114, 884, false},
    {"meshes/swirl.smf", 9216, 18050, 380, false},
    {"meshes/globe-rgb.smf", 36866, 73728, 0, true},
    {"meshes/fandisk.obj", 6475, 12946, 0, true},
    {"meshes/fandisk_quads.off", 766, 764, 0, true},
    {"meshes/rocker-arm.obj", 10044, 20088, 0, true},
    {"meshes/anchor_dense.off", 3793, 7598, 0, true},
    {"meshes/joint.off", 221, 446, 0, true},
    {"meshes/couplingdown.off", 1841, 3714, 0, true},
    {"meshes/turbine.off", 9210, 18460, 0, true},
    {"meshes/1002_tray_bottom.STL", 2216, 4520, 0, true},
    {"meshes/featuretype.STL", 2010, 3476, kWelded, true},
    {"meshes/cycloidal.ply", 21384, 43368, 0, false},
    {"meshes/motorBike.obj.gz", 132871, 331653, kWelded, false},
    {"meshes/armadillo.obj.gz", 43243, 86482, 0, true},
    {"meshes/Lucy100k.ply", 50002, 100000, 0, true},
    {"meshes/buddha.obj", 49950, 100000, kWelded, false},
    {"meshes/david.ply", 30690, 61392, 0, true},
    {"meshes/dragon_vrip.ply.gz", 437645, 871414, kWelded, true},
    {"meshes/dragon_vrip_res3.ply.gz", 22998, 47794, kWelded, false},
    {"meshes/horse.ply", 48485, 96966, 0, true},
    {"meshes/igea.ply", 134345, 268686, 0, true},
    {"meshes/face.obj", 25905, 51712, 96, false},
    {"meshes/mannequin-devil.off", 12977, 25888, 64, false},
    {"meshes/max-planck-decimated.obj", 5272, 10540, 0, true},
    {"meshes/lion-head.off", 8356, 16674, 36, false},
    {"meshes/camelhead.off", 11381, 22704, 56, false},
    {"meshes/ChineseDragon-10kv.off", 10000, 19994, 6, false},
    {"meshes/bull.off", 6200, 12396, 0, true},
    {"meshes/fertility.off", 4494, 9000, 0, true},
    {"meshes/knot2.off", 5760, 11520, 0, true},
    {"meshes/knot_orig.ply", 12800, 25600, 0, true},
    {"meshes/cactus.off", 620, 1236, 0, true},
    {"meshes/sphere.off", 162, 320, 0, true},
    {"meshes/teapot.obj", 3644, 6320, kWelded, false},
    {"textured/spot/spot_triangulated.obj", 2930, 5856, 0, true},
    {"textured/spot/spot_quadrangulated.obj", 2930, 2928, 0, true},
    {"textured/spot/spot_control_mesh.obj", 188, 180, 0, true},
    {"textured/north-america/north-america.smf", 2025, 3872, 176, false},
    {"textured/fuze/fuze.obj", 502, 1000, 0, true},
    {"textured/fuze/fuze.ply", 502, 1000, 0, true},
    {"textured/capsule/capsule.obj", 5252, 10200, kWelded, true},
    {"textured/head-lps/head.obj", 9223, 17684, kWelded, false},
    {"textured/bunny10k_textured.ply", 5051, 9999, 109, false},
};

bool is_stl(const std::string& file) {
    return file.ends_with(".STL");
}

}  // namespace

TEST_CASE("Real models have the vertices and faces they are known for") {
    for (const Model& model : kModels) {
        const auto file = model_file(model.file);
        if (!file) continue;
        INFO(model.file);
        SourceMesh source = read_mesh_file(*file);
        CHECK(polygons(source) == model.faces);
        if (!is_stl(model.file)) CHECK(source.positions.size() == model.vertices);
        RepairReport report;
        const IndexedMesh mesh = repaired(std::move(source), &report);
        check_invariants(mesh);
        CHECK(mesh.closed == model.closed);
        if (model.boundary_edges != kWelded) CHECK(report.boundary_edges == model.boundary_edges);
        if (model.closed) CHECK(mesh.consistently_oriented);
        if (is_stl(model.file)) CHECK(mesh.positions.size() <= model.vertices);
    }
}

TEST_CASE("Textured models come with their image and texture coordinates") {
    struct Textured {
        const char* file;
        std::uint32_t width, height;
    };
    for (const Textured& model : {Textured{"textured/fuze/fuze.obj", 1024, 1024},
                                  {"textured/fuze/fuze.ply", 1024, 1024},
                                  {"textured/capsule/capsule.obj", 2048, 1024},
                                  {"textured/north-america/north-america.smf", 512, 512},
                                  {"textured/head-lps/head.obj", 1024, 1024}}) {
        const auto file = model_file(model.file);
        if (!file) continue;
        INFO(model.file);
        const SourceMesh mesh = read_mesh_file(*file);
        CHECK(mesh.warnings.empty());
        CHECK(mesh.corner_uvs.size() == mesh.corner_position.size());
        REQUIRE(mesh.images.size() == 1);
        CHECK(mesh.images[0].width == model.width);
        CHECK(mesh.images[0].height == model.height);
        for (const std::uint32_t material : mesh.polygon_material)
            REQUIRE(mesh.materials.at(material).image == 0);
    }
}

TEST_CASE("Coloured models are coloured") {
    for (const char* name :
         {"meshes/cycloidal.ply", "meshes/cactus.off", "meshes/dragon-50000.smf", "meshes/globe-rgb.smf",
          "meshes/swirl.smf", "broken/cube-vertexcol.obj", "broken/comments.off"}) {
        const auto file = model_file(name);
        if (!file) continue;
        INFO(name);
        const SourceMesh mesh = read_mesh_file(*file);
        REQUIRE(mesh.corner_colours.size() == mesh.corner_position.size());
    }
    const auto globe = model_file("meshes/globe-rgb.smf");
    if (globe) {
        const auto colours = read_mesh_file(*globe).corner_colours;
        CHECK(std::set<std::uint32_t>(colours.begin(), colours.end()).size() > 100);
    }
    const auto cactus = model_file("meshes/cactus.off");
    if (cactus) CHECK(read_mesh_file(*cactus).corner_colours.front() == 0xffc0c0c0u);
}

TEST_CASE("Formats that are not supported are refused") {
    for (const char* name :
         {"textured/Duck.glb", "textured/BoxTextured.glb", "pointclouds/autzen_trim.las", "pointclouds/kitten.xyz",
          "pointclouds/min_cut_segmentation_tutorial.pcd", "meshes/mt_rainier_90m.tif.gz"}) {
        const auto file = model_file(name);
        if (!file) continue;
        CHECK_THAT(input_error([&] { read_mesh_file(*file); }), Catch::Contains("OBJ, PLY, STL, OFF and SMF"));
    }
    const auto points = model_file("pointclouds/ball.ply");
    if (points) CHECK_THAT(input_error([&] { read_mesh_file(*points); }), Catch::Contains("no faces"));
}
