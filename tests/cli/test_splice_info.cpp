#include "preprocess/model_format/model.h"
#include "tests/cli/mesh_files.h"
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <fstream>

using namespace splice;
using Catch::Matchers::Contains;
using test::Outcome;
using test::TemporaryFolder;

namespace {

Outcome info(std::vector<std::string> arguments) {
    return test::run({test::program("splice-info"), std::move(arguments)});
}

std::filesystem::path baked_torus(const TemporaryFolder& folder) {
    test::write_bumpy_torus(folder / "torus.off", 24);
    REQUIRE(test::run({test::program("splice-bake"), {"torus.off", "--quiet"}, folder.path()}).exit_code == 0);
    return folder / "torus.splice";
}

}  // namespace

TEST_CASE("splice-info prints every section") {
    const TemporaryFolder folder;
    const Outcome outcome = info({baked_torus(folder).string()});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    for (const char* section : {"model info", "vertices", "indices", "surfels", "patches", "levels of detail", "octree",
                                "merge tree", "materials", "textures", "texels"})
        CHECK_THAT(outcome.out, Contains(section));
    CHECK_THAT(outcome.out, Contains("2,304 triangles") && Contains("closed"));
}

TEST_CASE("splice-info --json agrees with the model") {
    const TemporaryFolder folder;
    const auto path = baked_torus(folder);
    const Outcome outcome = info({path.string(), "--json"});
    REQUIRE(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(outcome.out);
    const ModelFile file(path);
    CHECK(json.at("file_bytes") == std::filesystem::file_size(path));
    CHECK(json.at("source").at("triangles") == 2304);
    CHECK(json.at("two_sided") == false);
    CHECK(json.at("drawn").at("surfels") == file.view().surfel_count());
    CHECK(json.at("sections").size() == 13);
    CHECK(json.at("sections")[1].at("count") == file.view().vertices.size());
    CHECK(json.at("sections")[3].at("element_bytes") == 32);
    CHECK(json.at("levels")[0].at("triangles") == 2304);
    CHECK(json.at("patches").at("triangle").get<std::size_t>() + json.at("patches").at("surfel").get<std::size_t>() ==
          file.view().patches.size());
}

TEST_CASE("splice-info tells what is wrong with a damaged model") {
    const TemporaryFolder folder;
    const auto path = baked_torus(folder);
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(1000);
        file.put('\x55');
    }
    const Outcome outcome = info({path.string()});
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.out.empty());
    CHECK(test::line_count(outcome.err) == 1);
    CHECK_THAT(outcome.err, Contains("torus.splice: byte 24: checksum"));
    std::filesystem::resize_file(path, 5000);
    CHECK_THAT(info({path.string()}).err, Contains("should have"));
}

TEST_CASE("splice-info refuses what it does not understand") {
    CHECK(info({}).exit_code == 2);
    CHECK(info({"a.splice", "b.splice"}).exit_code == 2);
    CHECK(info({"a.splice", "--yaml"}).exit_code == 2);
    CHECK(info({"absent.splice"}).exit_code == 1);
    CHECK(info({"--help"}).exit_code == 0);
    CHECK(info({"--version"}).out.starts_with("splice-info "));
}
