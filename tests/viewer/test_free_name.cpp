// Names for new files: nothing that is there is written over.
#include "engine/viewer/free_name.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>

using namespace splice;

TEST_CASE("a name that is taken is numbered, links to nowhere count as taken") {
    const test::TemporaryFolder folder;
    CHECK(free_name(folder / "a.png") == folder / "a.png");
    std::ofstream(folder / "a.png") << "x";
    CHECK(free_name(folder / "a.png") == folder / "a-1.png");
    std::filesystem::create_symlink("nowhere", folder / "a-1.png");
    CHECK(free_name(folder / "a.png") == folder / "a-2.png");
}

TEST_CASE("a series is taken where one of its pictures is there") {
    const test::TemporaryFolder folder;
    CHECK(free_series(folder / "turn.png", 3) == folder / "turn.png");
    std::ofstream(folder / "turn-002.png") << "x";
    CHECK(free_series(folder / "turn.png", 2) == folder / "turn.png");
    CHECK(free_series(folder / "turn.png", 3) == folder / "turn-1.png");
}
