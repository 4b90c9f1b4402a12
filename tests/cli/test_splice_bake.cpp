#include "preprocess/model_format/model.h"
#include "tests/cli/mesh_files.h"
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <fstream>

using namespace splice;
using Catch::Matchers::Contains;
using test::line_count;
using test::Outcome;
using test::TemporaryFolder;

namespace {

Outcome bake(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    return test::run(
        {.program = test::program("splice-bake"), .arguments = std::move(arguments), .folder = folder.path()});
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
}

}  // namespace

TEST_CASE("splice-bake needs no option: the model gets the input's name in the current folder") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "meshes");
    test::write_cube(folder / "meshes/cube.obj");
    const Outcome outcome = bake(folder, {"meshes/cube.obj"});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("wrote") && Contains("cube.splice"));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"cube.splice", "meshes"});
    CHECK_NOTHROW(ModelFile(folder / "cube.splice"));
}

TEST_CASE("splice-bake drops .gz from the input's name") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    REQUIRE(test::run({.program = "gzip", .arguments = {"cube.obj"}, .folder = folder.path()}).exit_code == 0);
    CHECK(bake(folder, {"cube.obj.gz"}).exit_code == 0);
    CHECK(names_in(folder.path()) == std::vector<std::string>{"cube.obj.gz", "cube.splice"});
}

TEST_CASE("splice-bake --help names every option with its unit and gives examples") {
    const TemporaryFolder folder;
    const Outcome outcome = bake(folder, {"--help"});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    for (const char* text : {"--output",
                             "--triangle-share",
                             "--phase1-cost",
                             "--phase2-cost",
                             "--max-patch-area",
                             "--sampling adaptive|C",
                             "--h-min",
                             "--h-max",
                             "--sagitta LENGTH",
                             "--crease-spacing LENGTH",
                             "--representation hybrid|triangles|surfels",
                             "--selection geometric|thesis",
                             "--no-prune",
                             "--threads",
                             "--stats FILE",
                             "--quiet",
                             "share of",
                             "seconds",
                             "bytes",
                             "degrees",
                             "geometric 0.9, thesis 1.8",
                             "geometric no limit, thesis 0.1625",
                             "thesis 5.69 median triangles",
                             "Examples:",
                             "Exit code"})
        CHECK_THAT(outcome.out, Contains(text));
    CHECK(bake(folder, {"--version"}).out.starts_with("splice-bake "));
}

TEST_CASE("splice-bake --stats writes every promised figure, and they agree with the model") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 40);
    const Outcome outcome =
        bake(folder, {"torus.off", "-o", "out.splice", "--stats", "stats.json", "--triangle-share", "0.3"});
    REQUIRE(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder / "stats.json"));
    const ModelFile file(folder / "out.splice");
    const format::ModelInfo& info = *file.view().info;

    CHECK(json.at("input").at("vertices") == 3200);
    CHECK(json.at("input").at("triangles") == 6400);
    CHECK(json.at("input").at("boundary_edges") == 0);
    CHECK(json.at("input").at("nonmanifold_edges") == 0);
    CHECK(json.at("repair").at("triangles") == info.source_triangles);
    CHECK(json.at("repair").at("computed_normals") == 3 * 6400);
    for (const char* key :
         {"welded_vertices", "isolated_vertices", "degenerate_triangles", "duplicate_triangles", "invalid_polygons"})
        CHECK(json.at("repair").at(key) == 0);
    std::size_t triangle_patches = 0;
    for (const format::Patch& patch : file.view().patches)
        triangle_patches += patch.representation == format::Representation::kTriangles;
    CHECK(json.at("patches").at("triangle") == triangle_patches);
    CHECK(json.at("patches").at("surfel") == file.view().patches.size() - triangle_patches);
    CHECK(json.at("output").at("triangles") == info.drawn_triangles);
    CHECK(json.at("output").at("surfels") == file.view().surfel_count());
    CHECK(json.at("output").at("file_bytes") == std::filesystem::file_size(folder / "out.splice"));
    CHECK(json.at("output").at("coverage_mean") >= 1.0);
    CHECK(json.at("selection").at("auc") >= 0.0);
    CHECK(json.at("selection").at("auc") <= 1.0);
    double sum = 0;
    for (const char* key : {"read", "repair", "cluster", "judge", "simplify", "sample", "prune", "write"}) {
        CHECK(json.at("seconds").at(key) >= 0.0);
        sum += json.at("seconds").at(key).get<double>();
    }
    CHECK(json.at("seconds").at("total").get<double>() >= 0.999 * sum);
    CHECK(json.at("peak_rss_bytes") > 1'000'000);
}

TEST_CASE(
    "splice-bake --stats has null for what cannot be measured: a choice without two kinds, disks without surfels") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    const auto stats_with = [&](const std::string& representation) {
        REQUIRE(bake(folder, {"cube.obj", "--stats", "stats.json", "--representation", representation}).exit_code == 0);
        return nlohmann::json::parse(read_text(folder / "stats.json"));
    };
    const auto triangles = stats_with("triangles"), surfels = stats_with("surfels");
    CHECK(triangles.at("selection").at("auc").is_null());
    CHECK(triangles.at("output").at("coverage_mean").is_null());
    CHECK(surfels.at("selection").at("auc").is_null());
    CHECK(surfels.at("output").at("coverage_mean") >= 1.0);
}

TEST_CASE("splice-bake prints stage lines into a file and a progress bar onto a terminal") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 40);
    const Outcome lines = bake(folder, {"torus.off"});
    for (const char* stage : {"read", "repair", "cluster", "simplify", "sample", "write"})
        CHECK_THAT(lines.err, Contains(stage));
    CHECK_THAT(lines.err, !Contains("\r") && !Contains("["));
    const Outcome bar = test::run({.program = test::program("splice-bake"),
                                   .arguments = {"torus.off"},
                                   .folder = folder.path(),
                                   .stderr_is_terminal = true});
    CHECK(bar.exit_code == 0);
    CHECK_THAT(bar.err, Contains("\r") && Contains("[") && Contains("%"));
}

TEST_CASE("splice-bake --quiet says nothing") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    const Outcome outcome = bake(folder, {"cube.obj", "--quiet"});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.empty());
}

TEST_CASE("splice-bake tells what repair did, and only that") {
    const TemporaryFolder folder;
    std::ofstream(folder / "awkward.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 2 3\nf 1 1 2\n";
    const Outcome outcome = bake(folder, {"awkward.obj"});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("1 isolated vertex dropped") && Contains("1 duplicate triangle dropped"));
    CHECK_THAT(outcome.out, !Contains("vertices welded"));
}

TEST_CASE("splice-bake --representation makes everything triangles or everything surfels") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 24);
    REQUIRE(bake(folder, {"torus.off", "-o", "t.splice", "--representation", "triangles"}).exit_code == 0);
    REQUIRE(bake(folder, {"torus.off", "-o", "s.splice", "--representation", "surfels"}).exit_code == 0);
    const ModelFile triangles(folder / "t.splice"), surfels(folder / "s.splice");
    CHECK(triangles.view().surfels.empty());
    CHECK(triangles.view().info->drawn_triangles == triangles.view().info->source_triangles);
    CHECK(surfels.view().info->drawn_triangles == 0);
    CHECK(!surfels.view().surfels.empty());
}

TEST_CASE("splice-bake writes the same bytes for any number of threads") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 40);
    for (const char* threads : {"1", "2", "7"})
        REQUIRE(
            bake(folder, {"torus.off", "-o", threads + std::string(".splice"), "--threads", threads, "--h-min", "0.01"})
                .exit_code == 0);
    const std::string one = read_text(folder / "1.splice");
    CHECK(!one.empty());
    CHECK(one == read_text(folder / "2.splice"));
    CHECK(one == read_text(folder / "7.splice"));
}

TEST_CASE("splice-bake refuses every malformed option with one line and exit code 2") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    const std::vector<std::vector<std::string>> wrong = {{"--triangle-share", "1.5"},
                                                         {"--triangle-share", "-0.1"},
                                                         {"--triangle-share", "nan"},
                                                         {"--triangle-share", ""},
                                                         {"--triangle-share", "half"},
                                                         {"--triangle-share", "0.5x"},
                                                         {"--triangle-share"},
                                                         {"--phase1-cost", "inf"},
                                                         {"--phase1-cost", "1e999"},
                                                         {"--phase2-cost", "nan"},
                                                         {"--max-patch-area", "0"},
                                                         {"--max-patch-area", "-1"},
                                                         {"--max-patch-area", "2"},
                                                         {"--sampling", "adaptiv"},
                                                         {"--sampling", "0"},
                                                         {"--sampling", "-4"},
                                                         {"--sampling", "nan"},
                                                         {"--sampling", "1000"},
                                                         {"--h-min", "0"},
                                                         {"--h-min", "-0.1"},
                                                         {"--h-min", "nan"},
                                                         {"--h-max", "2"},
                                                         {"--sagitta", "0"},
                                                         {"--crease-spacing", "2"},
                                                         {"--h-max", "1e-9"},
                                                         {"--h-min", "0.1", "--h-max", "0.01"},
                                                         {"--representation", "points"},
                                                         {"--selection", "best"},
                                                         {"--threads", "-1"},
                                                         {"--threads", "1.5"},
                                                         {"--threads", "many"},
                                                         {"--threads", "99999999999999999999"},
                                                         {"--lod-levels", "0"},
                                                         {"--lod-levels", "17"},
                                                         {"--crease-angle", "181"},
                                                         {"--crease-angle", "-1"},
                                                         {"--unknown"},
                                                         {"-x"},
                                                         {"second.obj"},
                                                         {"--quiet=maybe"},
                                                         {"--no-prune=3"},
                                                         {"--triangle-share", "0.5", "--triangle-share", "0.6"},
                                                         {"--triangle-share", "0.5", "--representation", "triangles"},
                                                         {"-o", "cube.obj"},
                                                         {"-o", "./cube.obj"},
                                                         {"--stats", "cube.obj"},
                                                         {"--stats", "cube.splice"},
                                                         {"-o", ""},
                                                         {"--stats", ""}};
    for (const auto& options : wrong) {
        std::vector<std::string> arguments = {"cube.obj"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = bake(folder, arguments);
        INFO(options[0] << ' ' << (options.size() > 1 ? options[1] : "") << ": " << outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(outcome.out.empty());
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.starts_with("splice-bake: "));
        CHECK(names_in(folder.path()) == std::vector<std::string>{"cube.obj"});
    }
    CHECK(bake(folder, {""}).exit_code == 2);
    const Outcome nothing = bake(folder, {});
    CHECK(nothing.exit_code == 2);
    CHECK(line_count(nothing.err) == 1);
    CHECK_THAT(nothing.err, Contains("INPUT"));
}

TEST_CASE("splice-bake never writes over its input or its other output, however they are spelled") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    test::write_cube(folder / "cube.obj");
    std::filesystem::create_symlink("cube.obj", folder / "link.splice");
    std::filesystem::create_hard_link(folder / "cube.obj", folder / "hard.splice");
    std::filesystem::create_symlink("x.splice", folder / "dangling.json");
    std::filesystem::create_directory_symlink(".", folder / "here");
    const std::string before = read_text(folder / "cube.obj");
    const std::vector<std::string> names = names_in(folder.path());
    const std::string absolute = (folder / "x.splice").string();
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"-o", (folder / "cube.obj").string()},
                                               {"-o", "sub/../cube.obj"},
                                               {"-o", "link.splice"},
                                               {"-o", "hard.splice"},
                                               {"-o", "here/cube.obj"},
                                               {"--stats", "./cube.obj"},
                                               {"--stats", "./cube.splice"},  // the default output
                                               {"-o", "x.splice", "--stats", "./x.splice"},
                                               {"-o", "./x.splice", "--stats", "x.splice"},
                                               {"-o", "x.splice", "--stats", absolute},
                                               {"-o", absolute, "--stats", "sub/../x.splice"},
                                               {"-o", "x.splice", "--stats", "here/x.splice"},
                                               {"-o", "x.splice", "--stats", "dangling.json"}}) {
        std::vector<std::string> arguments = {"cube.obj", "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = bake(folder, arguments);
        INFO(options.back() << ": " << outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Contains("would overwrite"));
        CHECK(read_text(folder / "cube.obj") == before);
        CHECK(names_in(folder.path()) == names);
    }
}

TEST_CASE("splice-bake never writes over a material or a texture that its input names") {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
    };
    write("quad.obj",
          "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl paint\nf 1/1 2/2 3/3\n");
    write("quad.mtl", "newmtl paint\nmap_Kd paint.ppm\n");
    write("paint.ppm", "P6\n1 1\n255\nabc");
    std::filesystem::create_symlink("paint.ppm", folder / "link");
    const std::vector<std::string> names = names_in(folder.path());
    const std::string material = read_text(folder / "quad.mtl"), texture = read_text(folder / "paint.ppm");
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"-o", "paint.ppm"}, {"-o", "./quad.mtl"}, {"-o", "link"}, {"-o", "x.splice", "--stats", "paint.ppm"}}) {
        std::vector<std::string> arguments = {"quad.obj", "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = bake(folder, arguments);
        INFO(options.back() << ": " << outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Contains("would overwrite INPUT's material or texture"));
        CHECK(read_text(folder / "quad.mtl") == material);
        CHECK(read_text(folder / "paint.ppm") == texture);
        CHECK(names_in(folder.path()) == names);
    }
}

TEST_CASE("splice-bake accepts the limits of its options") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--triangle-share", "0", "--h-min", "0.05"},
                                               {"--triangle-share", "1"},
                                               {"--phase1-cost", "-0.5"},
                                               {"--max-patch-area", "1"},
                                               {"--sampling", "0.1"},
                                               {"--sampling", "adaptive"},
                                               {"--h-max", "0.0002"},
                                               {"--h-min", "0.5"},
                                               {"--threads", "0"},
                                               {"--threads", "1024"},
                                               {"--lod-levels", "1"},
                                               {"--crease-angle", "0"},
                                               {"--no-prune"},
                                               {"--selection", "thesis", "--h-min", "0.05"}}) {
        std::vector<std::string> arguments = {"cube.obj"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = bake(folder, arguments);
        INFO(options[0] << ": " << outcome.err);
        CHECK(outcome.exit_code == 0);
    }
}

TEST_CASE("splice-bake says in one line what is wrong with an input, and leaves no output") {
    const TemporaryFolder folder;
    std::ofstream(folder / "empty.obj");
    std::ofstream(folder / "noise.ply") << "ply\nformat martian 1.0\nend_header\n";
    std::ofstream(folder / "points.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    std::ofstream(folder / "cut.off") << "OFF\n8 6 0\n0 0 0\n";
    std::ofstream(folder / "two\nlines.obj") << "v 0 0 0\n";
    std::filesystem::create_directory(folder / "folder.obj");
    std::ofstream(folder / "line.obj") << "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";  // read well, refused by repair
    for (const char* input : {"absent.obj", "empty.obj", "noise.ply", "points.obj", "cut.off", "folder.obj",
                              "two\nlines.obj", "line.obj"}) {
        const Outcome outcome = bake(folder, {input, "-o", "out.splice"});
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK(outcome.out.empty());
        CHECK(line_count(outcome.err) == 1);
        CHECK(!std::filesystem::exists(folder / "out.splice"));
    }
}

TEST_CASE("splice-bake notices an impossible output before it works") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    std::filesystem::create_directory(folder / "folder.splice");
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"-o", "absent/out.splice"},
                                               {"-o", "folder.splice"},
                                               {"-o", "/dev/null"},
                                               {"-o", "cube.obj/out.splice"},
                                               {"--stats", "absent/stats.json"}}) {
        std::vector<std::string> arguments = {"cube.obj"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = bake(folder, arguments);
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);  // no stage line comes before it
        CHECK_THAT(outcome.err, Contains("cannot write"));
        CHECK(names_in(folder.path()) == std::vector<std::string>{"cube.obj", "folder.splice"});
    }
}

TEST_CASE("splice-bake makes a model of a point cloud and says what it dropped") {
    const TemporaryFolder folder;
    std::ofstream file(folder / "scan.xyz");
    file.precision(12);
    for (int i = 0; i < 400; ++i)
        file << 512345.5 + i % 20 << ' ' << 5403059 + i / 20 << " 247.5 200 " << i % 256 << " 30\n";
    file << "nan 0 0 1 2 3\n512345.5 5403059 247.5 1 2 3\n";
    file.close();
    const Outcome outcome = bake(folder, {"scan.xyz", "--neighbours", "12", "--stats", "scan.json"});
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("402 points") && Contains("1 point that is not finite dropped") &&
                                Contains("1 duplicate point dropped") && Contains("400 surfels"));
    const auto stats = nlohmann::json::parse(read_text(folder / "scan.json"));
    CHECK(stats["input"]["points"] == 402);
    CHECK(stats["cloud"]["nonfinite_points"] == 1);
    CHECK(stats["cloud"]["duplicate_points"] == 1);
    CHECK(stats["cloud"]["estimated_normals"] == 400);
    CHECK(stats["cloud"]["plane_neighbours"] == 12);
    CHECK(stats["output"]["surfels"] == 400);
    const Outcome info =
        test::run({.program = test::program("splice-info"), .arguments = {"scan.splice"}, .folder = folder.path()});
    CHECK(info.exit_code == 0);
    CHECK_THAT(info.out, Contains("400 points") && Contains("point cloud") && Contains("colours"));
}

TEST_CASE("splice-bake refuses what it cannot do with a point cloud in one line") {
    const TemporaryFolder folder;
    std::ofstream(folder / "scan.xyz") << "0 0 0\n1 0 0\n0 1 0\n";
    const Outcome triangles = bake(folder, {"scan.xyz", "--representation", "triangles"});
    CHECK(triangles.exit_code == 2);
    CHECK_THAT(triangles.err, Contains("no triangles"));
    CHECK(bake(folder, {"scan.xyz", "--neighbours", "5"}).exit_code == 2);
    std::string laz = "LASF" + std::string(371, '\0');
    laz[24] = 1;
    laz[25] = 2;
    laz[94] = static_cast<char>(227);
    laz[104] = static_cast<char>(0x83);
    std::ofstream(folder / "scan.laz", std::ios::binary) << laz;
    const Outcome compressed = bake(folder, {"scan.laz"});
    CHECK(compressed.exit_code == 1);
    CHECK(line_count(compressed.err) == 1);
    CHECK_THAT(compressed.err, Contains("LAZ") && Contains("uncompress"));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"scan.laz", "scan.xyz"});
}
