// A full disk behind standard output is a failure like any other.
#include "tests/cli/mesh_files.h"
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

using namespace splice;
using namespace splice::test;

namespace {

Outcome run_onto_full_disk(const TemporaryFolder& folder, const std::string& name, std::vector<std::string> arguments) {
    return run({.program = program(name), .arguments = std::move(arguments), .folder = folder.path(), .in_child = [] {
                    if (!std::freopen("/dev/full", "w", stdout)) std::abort();
                }});
}

}  // namespace

TEST_CASE("A program whose standard output is full says so in one line and fails") {
    const TemporaryFolder folder;
    write_cube(folder / "cube.obj");
    REQUIRE(run({program("splice-bake"), {"cube.obj", "--quiet"}, folder.path()}).exit_code == 0);
    const std::vector<std::pair<std::string, std::vector<std::string>>> runs = {
        {"splice-info", {"cube.splice"}}, {"splice-info", {"cube.splice", "--json"}},
        {"splice-info", {"--help"}},      {"splice-info", {"--version"}},
        {"splice-bake", {"--help"}},      {"splice-bake", {"--version"}}};
    for (const auto& [name, arguments] : runs) {
        const Outcome outcome = run_onto_full_disk(folder, name, arguments);
        INFO(name << ' ' << arguments.back() << ": " << outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Catch::StartsWith(name + ": cannot write to standard output"));
    }
}

TEST_CASE("A bake that may not print its summary fails, one that prints nothing does not") {
    const TemporaryFolder folder;
    write_cube(folder / "cube.obj");
    const Outcome told = run_onto_full_disk(folder, "splice-bake", {"cube.obj"});
    CHECK(told.exit_code == 1);
    CHECK_THAT(told.err, Catch::Contains("splice-bake: cannot write to standard output"));
    CHECK(run_onto_full_disk(folder, "splice-bake", {"cube.obj", "--quiet"}).exit_code == 0);
}
