#include "engine/bench/frame/frame_report.h"
#include "engine/bench/report/changes.h"
#include "preprocess/model_format/error.h"
#include "tests/bench/markup_checker.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>

using namespace splice;
using Catch::Contains;

namespace {

bench::FrameRow row(const std::string& scene, const std::string& backend, double ms, std::uint64_t covered) {
    bench::FrameRow one;
    one.scene = scene;
    one.backend = backend;
    one.shading = "surfel";
    one.width = one.height = 100;
    one.surfels = 50'000;
    one.covered_pixels = covered;
    one.fragments = 200'000;
    one.frame_ms = bench::summarise({ms, ms * 1.01, ms * 1.02});
    one.cpu_ms = bench::scaled(one.frame_ms, 2);
    one.passes = {{"setup <&>", bench::scaled(one.frame_ms, 0.25)}, {"gather", bench::scaled(one.frame_ms, 0.5)}};
    one.drawn_by = {{backend, one.surfels}};
    return one;
}

bench::FrameReport report_of(double tile_ms) {
    bench::FrameReport report{.device = "a <device> & more", .rounds = 3, .rows = {}};
    report.rows = {row("bumpy-sphere 50000", "sprite", 100, 4600), row("bumpy-sphere 50000", "auto", tile_ms, 4600),
                   row("bumpy-sphere 50000", "bare", 90, 4600), row("bumpy-sphere 1000000", "auto", 50, 4600),
                   row("bumpy-sphere 1000000 far", "auto", 40, 1300)};
    return report;
}

}  // namespace

TEST_CASE("goals of frames compare the rows that they are about") {
    const std::vector<bench::FrameGoal> goals = goals_of(report_of(20));
    REQUIRE(goals.size() == 3);
    CHECK(goals[0].reached == Approx(5));
    CHECK(goals[0].met());
    CHECK(goals[1].reached == Approx(100.0 / 90));
    CHECK(goals[1].met());
    CHECK(goals[2].reached == Approx(0.8));
    CHECK_FALSE(goals[2].met());
    CHECK_FALSE(goals_of(report_of(30))[0].met());
    CHECK(bench::goals_of({}).empty());
}

TEST_CASE("the table of frames has rates by the median and the backends that drew") {
    const std::string text = frame_report_text(report_of(20));
    CHECK_THAT(text, Contains("5.00") && Contains("auto 50000") && Contains("setup <&>"));
    // 50,000 surfels and 200,000 fragments in 20.2 ms.
    CHECK_THAT(text, Contains("2.48") && Contains("9.9"));
}

TEST_CASE("the page of frames is well-formed and has a drawing a scene") {
    const test::MarkupCheck check = test::check_markup(frame_report_html(report_of(20)));
    CHECK(check.problem == "");
    CHECK(check.elements.at("svg") == 3);
    CHECK(check.elements.at("table") == 1);
}

TEST_CASE("a report of frames says what moved since an earlier one") {
    const nlohmann::json before = frame_report_json(report_of(20)), now = frame_report_json(report_of(30));
    CHECK_THAT(bench::compare_frame_reports(before, now, "old.json"),
               Contains("bumpy-sphere 50000, auto, surfel, 100x100: frame, ms") && Contains("slower"));
    CHECK_THAT(bench::compare_frame_reports(before, before, "old.json"), Contains("0 of "));
    nlohmann::json broken = before;
    broken["frames"][0].erase("frame_ms");
    CHECK_THROWS_AS(bench::compare_frame_reports(broken, now, "old.json"), InputError);
}

TEST_CASE("a report of another benchmark is refused") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "other.json") << R"({"benchmark": "splice-bench graph", "version": 1})";
    CHECK_THROWS_WITH(
        bench::read_report_of({bench::kFrameReportKind, bench::kFrameReportVersion}, folder / "other.json"),
        Contains("not a report that splice-bench frame --json wrote"));
}
