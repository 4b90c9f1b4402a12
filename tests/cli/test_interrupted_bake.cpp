// A bake that is killed or runs out of space leaves no output behind, and an older output whole.
#include "preprocess/model_format/model.h"
#include "tests/cli/mesh_files.h"
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

using namespace splice;
using Catch::Matchers::Contains;
using test::Outcome;
using test::TemporaryFolder;

namespace {

// Coarse surfels: the bakes here are many and need not be fine.
std::vector<std::string> quick_bake(const std::string& output) {
    return {"torus.off", "-o", output, "--h-min", "0.02", "--h-max", "0.03", "--threads", "2", "--quiet"};
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace

TEST_CASE("a killed bake leaves a whole model or nothing") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 30);
    const auto start = std::chrono::steady_clock::now();
    const test::Spawn undisturbed{test::program("splice-bake"), quick_bake("whole.splice"), folder.path()};
    REQUIRE(test::run(undisturbed).exit_code == 0);
    const auto whole = std::chrono::steady_clock::now() - start;
    const auto size = std::filesystem::file_size(folder / "whole.splice");
    const std::size_t files = files_in(folder.path());

    // Moments all over the run, its end more densely, where the file is written.
    for (const int signal_number : {SIGKILL, SIGTERM, SIGINT}) {
        for (const int percent : {20, 80, 95, 100, 105}) {
            test::Spawn disturbed{test::program("splice-bake"), quick_bake("out.splice"), folder.path()};
            disturbed.while_it_runs = [&](int process) {
                std::this_thread::sleep_for(whole * percent / 100);
                kill(process, signal_number);
            };
            const Outcome outcome = test::run(disturbed);
            INFO("signal " << signal_number << " at " << percent << " %");
            CHECK((outcome.exit_code == 0 || outcome.signal == signal_number));
            if (std::filesystem::exists(folder / "out.splice")) {
                CHECK(std::filesystem::file_size(folder / "out.splice") == size);
                CHECK_NOTHROW(ModelFile(folder / "out.splice"));
                std::filesystem::remove(folder / "out.splice");
            }
            CHECK(files_in(folder.path()) == files);
        }
    }
}

TEST_CASE("a bake that runs out of space says so and leaves an older output alone") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 24);
    test::Spawn limited{test::program("splice-bake"), quick_bake("out.splice"), folder.path()};
    limited.in_child = [] {
        const rlimit limit{10'000, 10'000};
        setrlimit(RLIMIT_FSIZE, &limit);
    };
    const Outcome outcome = test::run(limited);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Contains("out.splice: cannot write: File too large"));
    CHECK(test::line_count(outcome.err) == 1);
    CHECK(files_in(folder.path()) == 1);

    std::ofstream(folder / "out.splice") << "older";
    CHECK(test::run(limited).exit_code == 1);
    CHECK(std::filesystem::file_size(folder / "out.splice") == 5);
    CHECK(files_in(folder.path()) == 2);
}

TEST_CASE("a bake whose stats cannot be written fails") {
    const TemporaryFolder folder;
    test::write_cube(folder / "cube.obj");
    const Outcome outcome = test::run(
        {test::program("splice-bake"), {"cube.obj", "--stats", "/proc/stats.json", "--quiet"}, folder.path()});
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Contains("/proc/stats.json"));
}

// AddressSanitizer's own memory exceeds the limit.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("a bake without enough memory says so in one line") {
    const TemporaryFolder folder;
    test::write_bumpy_torus(folder / "torus.off", 150);
    test::Spawn limited{test::program("splice-bake"),
                        {"torus.off", "--representation", "triangles", "--quiet", "--threads", "1"},
                        folder.path()};
    limited.in_child = [] {
        const rlimit limit{20'000'000, 20'000'000};
        setrlimit(RLIMIT_DATA, &limit);
    };
    const Outcome outcome = test::run(limited);
    CHECK(outcome.exit_code == 1);
    CHECK(test::line_count(outcome.err) == 1);
    CHECK(outcome.signal == 0);
}
#endif
