#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

using namespace splice;

namespace {

struct Outcome {
    int exit_code;
    std::string out, err;
};

std::string contents(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

Outcome bench(const std::string& arguments) {
    const test::TemporaryFolder folder;
    const std::string command = "'" + test::program("splice-bench").string() + "' " + arguments + " >'" +
                                (folder / "out").string() + "' 2>'" + (folder / "err").string() + "' </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / "out"), contents(folder / "err")};
}

bool one_line(const std::string& text) {
    return !text.empty() && text.find('\n') == text.size() - 1;
}

}  // namespace

TEST_CASE("splice-bench --help names its commands and options") {
    const Outcome top = bench("--help");
    CHECK(top.exit_code == 0);
    for (const char* word : {"bake", "capture", "holes", "quality", "graph"})
        CHECK(top.out.find(word) != std::string::npos);
    const Outcome holes = bench("holes --help");
    CHECK(holes.exit_code == 0);
    for (const char* word : {"--directions", "--size", "--json", "--pictures"})
        CHECK(holes.out.find(word) != std::string::npos);
    const Outcome graph = bench("graph --help");
    CHECK(graph.exit_code == 0);
    for (const char* word : {"--families", "--sizes", "--seed", "--repeat", "--no-device", "--json", "--html", "--vs",
                             "layered-local", "before.json"})
        CHECK(graph.out.find(word) != std::string::npos);
}

TEST_CASE("splice-bench answers a wrong command line with one line and exit code 2") {
    for (const char* arguments : {"",
                                  "no-such-command",
                                  "holes --directions 27",
                                  "holes --directions x",
                                  "capture --size 0x5",
                                  "capture --size 12",
                                  "bake --runs 0",
                                  "bake no-such-file.obj",
                                  "holes --representation points",
                                  "capture --triangle-share 2",
                                  "graph --sizes 3",
                                  "graph --sizes 64,x",
                                  "graph --repeat 0",
                                  "graph --seed -",
                                  "graph --no-device --families tree",
                                  "graph --no-device --families frame",
                                  "graph --device nonsense",
                                  "graph extra",
                                  "frame no-such-model.splice",
                                  "frame --backend beige",
                                  "frame --size 12",
                                  "frame --count 0",
                                  "frame --rounds 0",
                                  "frame --points-below 65",
                                  "quality no-such-mesh.obj",
                                  "quality bumpy-sphere x",
                                  "quality bumpy-sphere 0",
                                  "quality --backend beige",
                                  "quality --shading cel",
                                  "quality --antialias 0",
                                  "capture --antialias 9",
                                  "quality --depth 0",
                                  "quality --depth nan",
                                  "frame --merge nan",
                                  "costs --tau 1,nan",
                                  "capture --sagitta nan"}) {
        INFO(arguments);
        const Outcome outcome = bench(arguments);
        CHECK(outcome.exit_code == 2);
        CHECK(one_line(outcome.err));
        CHECK(outcome.out.empty());
    }
}

TEST_CASE("splice-bench says in plain words what an option allows") {
    for (const auto& [arguments, allowed] : std::vector<std::pair<const char*, const char*>>{
             {"bake --runs 0", "1 to 1000"},
             {"capture --frames -1", "1 to 100000"},
             {"holes --representation points", "'points' is none of hybrid, triangles, surfels"},
             {"capture --h-max 2", "--h-max"},
             {"capture --epsilon-scale -1", "--epsilon-scale"}}) {
        const Outcome outcome = bench(arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(one_line(outcome.err));
        CHECK(outcome.err.find(allowed) != std::string::npos);
        CHECK(outcome.err.size() < 120);
    }
}

TEST_CASE("splice-bench measures a bake and writes what it printed as JSON") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "square.off") << "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    const Outcome outcome = bench("bake --runs 2 --json '" + (folder / "report.json").string() + "' '" +
                                  (folder / "square.off").string() + "'");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.out.find("square.off") != std::string::npos);
    const auto report = nlohmann::json::parse(contents(folder / "report.json"));
    REQUIRE(report.size() == 1);
    CHECK(report[0]["runs"].size() == 2);
    CHECK(report[0]["runs"][0]["output"]["triangles"] == 2);
}

TEST_CASE("splice-bench frame runs variants, and says what moved since it wrote a report") {
    const test::TemporaryFolder folder;
    const std::string report = (folder / "report.json").string(), page = (folder / "page.html").string();
    const Outcome outcome =
        bench("frame --count 2000 --size 96x64,32x32 --shading surfel,deferred --rounds 2 --json '" + report +
              "' --html '" + page + "'");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(contents(report));
    // Two sizes, two shadings of five backends, and the baseline.
    REQUIRE(json["frames"].size() == 2 * (2 * 5 + 1));
    for (const auto& frame : json["frames"]) {
        CHECK(frame["surfels"] == 2000);
        CHECK(frame["fragments"].get<int>() > 0);
        CHECK(frame["covered_pixels"].get<int>() > 0);
        CHECK(frame["frame_ms"]["minimum"].get<double>() > 0);
        CHECK(frame["passes"].empty() == (frame["backend"] == "bare"));
    }
    CHECK(contents(page).find("<svg") != std::string::npos);
    const Outcome again = bench(
        "frame --count 2000 --size 32x32 --backend tile,point --points-below 20 --rounds 1 --vs '" + report + "'");
    CHECK(again.exit_code == 0);
    CHECK(again.out.find("figures moved") != std::string::npos);
    CHECK(again.out.find("bare") == std::string::npos);
}

TEST_CASE("splice-bench quality measures meshes and scenes, and leaves pictures") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "two.json") << R"({"models": [
        {"shape": {"kind": "ico-sphere", "frequency": 8}, "transform": {"scale": 0.5}},
        {"shape": {"kind": "checkerboard"}, "transform": {"translation": [0.2, 0, -1]}}],
        "camera": {"azimuth": 10, "elevation": 5}, "background": "#203040"})";
    const Outcome outcome =
        bench("quality --size 96x64 --json '" + (folder / "report.json").string() + "' --pictures '" +
              (folder / "pictures").string() + "' '" + (folder / "two.json").string() + "'");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto report = nlohmann::json::parse(contents(folder / "report.json"));
    REQUIRE(report["pictures"].size() == 1);
    const auto& picture = report["pictures"][0];
    CHECK(picture["name"] == "two");
    // The frame shows what rays see: both models, in place, textured.
    CHECK(picture["inside_db"].get<double>() > 20);
    CHECK(picture["frame_db"].get<double>() > 20);
    CHECK(picture["iou"].get<double>() > 0.97);
    CHECK(picture["holes"] == 0);
    for (const char* name : {"two.png", "two-reference.png", "two-error.png"})
        CHECK(std::filesystem::exists(folder / "pictures" / name));
}

TEST_CASE("a million disks of the bumpy sphere are as true as they have to be, with one sample a pixel and with more") {
    const test::TemporaryFolder folder;
    const Outcome outcome =
        bench("quality bumpy-sphere 1000000 --antialias 1,3 --json '" + (folder / "report.json").string() + "'");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto pictures = nlohmann::json::parse(contents(folder / "report.json"))["pictures"];
    REQUIRE(pictures.size() == 2);
    for (const auto& picture : pictures) {
        CAPTURE(picture["antialias"].get<int>());
        CHECK(picture["inside_db"].get<double>() >= 57.1);
        CHECK(picture["frame_db"].get<double>() >= 38.5);
        CHECK(picture["iou"].get<double>() >= 0.999);
        CHECK(picture["holes"] == 0);
    }
    CHECK(pictures[1]["frame_db"].get<double>() >= 50);
}

TEST_CASE("splice-bench quality cannot know what a baked model was made from") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";
    const std::string model = (folder / "a.splice").string();
    REQUIRE(std::system(("'" + test::program("splice-bake").string() + "' '" + (folder / "a.off").string() + "' -o '" +
                         model + "' >/dev/null 2>&1")
                            .c_str()) == 0);
    const Outcome outcome = bench("quality '" + model + "'");
    CHECK(outcome.exit_code == 1);
    CHECK(one_line(outcome.err));
    CHECK(outcome.err.find("expected a mesh") != std::string::npos);
}

TEST_CASE("splice-bench never writes over what it reads") {
    const test::TemporaryFolder folder;
    const std::string mesh = (folder / "a.off").string(), scene = (folder / "scene.json").string(),
                      report = (folder / "old.json").string();
    const std::string triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n",
                      models = R"({"models": [{"file": "a.off"}]})";
    std::ofstream(mesh) << triangle;
    std::ofstream(scene) << models;
    std::ofstream(report) << "{}";
    for (const std::string& arguments :
         {"bake '" + mesh + "' --json '" + mesh + "'", "capture '" + mesh + "' --json '" + mesh + "'",
          "holes '" + mesh + "' --json '" + mesh + "'", "quality '" + mesh + "' --json '" + mesh + "'",
          "quality '" + scene + "' --json '" + mesh + "'", "frame '" + scene + "' --json '" + mesh + "'",
          "frame '" + scene + "' --html '" + scene + "'", "costs '" + scene + "' --json '" + scene + "'",
          "confetti '" + mesh + "' --json '" + mesh + "'", "levels '" + mesh + "' --json '" + mesh + "'",
          "graph --no-device --vs '" + report + "' --json '" + report + "'",
          "graph --no-device --json '" + report + ".new' --html '" + report + ".new'"}) {
        INFO(arguments);
        const Outcome outcome = bench(arguments);
        CHECK(outcome.exit_code == 2);
        CHECK(one_line(outcome.err));
        CHECK(outcome.err.find("would overwrite") != std::string::npos);
        CHECK(contents(mesh) == triangle);
        CHECK(contents(scene) == models);
        CHECK(contents(report) == "{}");
    }
}

TEST_CASE("splice-bench reports a mesh that cannot be baked as a failure") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "empty.obj") << "# nothing\n";
    const Outcome outcome = bench("bake '" + (folder / "empty.obj").string() + "'");
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.err.find("splice-bench: ") != std::string::npos);
}

TEST_CASE("splice-bench graph writes its figures and its page, and compares with an earlier run") {
    const test::TemporaryFolder folder;
    const std::string json = (folder / "report.json").string(), html = (folder / "report.html").string();
    const std::string common = "graph --no-device --families chain,deferred --sizes 64,8 --repeat 2 --seed 3";
    const Outcome first = bench(common + " --json '" + json + "' --html '" + html + "'");
    INFO(first.err);
    REQUIRE(first.exit_code == 0);
    CHECK(first.err.empty());  // progress is for terminals
    CHECK(first.out.find("deferred") != std::string::npos);
    const auto report = nlohmann::json::parse(contents(folder / "report.json"));
    REQUIRE(report["compile"].size() == 4);
    CHECK(report["compile"][0]["passes"] == 8);
    CHECK(report["seed"] == 3);
    CHECK(contents(folder / "report.html").find("<svg") != std::string::npos);

    const Outcome second = bench(common + " --vs '" + json + "'");
    CHECK(second.exit_code == 0);
    CHECK(second.out.find("figures moved") != std::string::npos);
    // Counts do not depend on the machine.
    for (const char* count : {": groups", ": barriers", ": placed bytes"})
        CHECK(second.out.find(count) == std::string::npos);
}

TEST_CASE("splice-bench graph fails before it measures when a file cannot be used") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "other.json") << "{}";
    for (const std::string& arguments :
         {"--vs '" + (folder / "absent.json").string() + "'", "--vs '" + (folder / "other.json").string() + "'",
          "--json '" + (folder / "no" / "such" / "folder.json").string() + "'",
          "--html '" + folder.path().string() + "'"}) {
        INFO(arguments);
        const Outcome outcome = bench("graph --no-device " + arguments);
        CHECK(outcome.exit_code == 1);
        CHECK(one_line(outcome.err));
        CHECK(outcome.out.empty());
    }
}
