// splice-bake over the collection of malformed and awkward files: it ends, and either makes a whole model or refuses.
#include "preprocess/model_format/model.h"
#include "tests/cli/spawn.h"
#include "tests/mesh/broken_models.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <string>

using namespace splice;
using namespace splice::test;

namespace {

// Every file ends within ten seconds; sanitizers take many times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr unsigned kHangSeconds = 600;
#else
constexpr unsigned kHangSeconds = 10;
#endif

Outcome bake(const std::filesystem::path& input, const TemporaryFolder& folder) {
    return run({.program = program("splice-bake"),
                .arguments = {input.string(), "-o", "out.splice", "--quiet"},
                .folder = folder.path(),
                .in_child = [] { alarm(kHangSeconds); }});
}

void check_bake(const std::string& name, const Expectation& triangles) {
    const auto cloud = kBrokenClouds.find(name);
    const auto file = model_file("broken/" + name);
    if (!file) return;
    const TemporaryFolder folder;
    const Outcome outcome = bake(*file, folder);
    INFO(name << ": " << outcome.err);
    CHECK(outcome.signal == 0);  // SIGALRM: it hung
    CHECK(outcome.out.empty());
    if (!triangles && cloud == kBrokenClouds.end()) {
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.starts_with("splice-bake: "));
        CHECK(std::filesystem::is_empty(folder.path()));
        return;
    }
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    REQUIRE(std::filesystem::exists(folder / "out.splice"));
    const ModelFile model(folder / "out.splice");
    CHECK(model.view().info->source_triangles == triangles.value_or(0));
    if (cloud != kBrokenClouds.end()) CHECK(model.view().surfel_count() == cloud->second);
    CHECK(run({program("splice-info"), {(folder / "out.splice").string()}}).exit_code == 0);
}

// Several cases of similar length, so that they run beside one another.
void check_every_third(std::ptrdiff_t first) {
    std::ptrdiff_t index = 0;
    for (const auto& [name, triangles] : kBrokenModels)
        if (index++ % 3 == first) check_bake(name, triangles);
}

}  // namespace

TEST_CASE("splice-bake makes a model of every broken file or refuses it: first third") {
    check_every_third(0);
}

TEST_CASE("splice-bake makes a model of every broken file or refuses it: second third") {
    check_every_third(1);
}

TEST_CASE("splice-bake makes a model of every broken file or refuses it: last third") {
    check_every_third(2);
}
