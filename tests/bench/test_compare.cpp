#include "engine/bench/graph/compare.h"
#include "engine/bench/graph/report_json.h"
#include "preprocess/model_format/error.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>

using namespace splice;
using Catch::Contains;

namespace {

bench::Sample around(double ns) {
    return {ns, ns * 0.95, ns * 0.98, ns * 1.02};
}

bench::GraphReport small_report() {
    bench::CompileResult result;
    result.family = "chain";
    result.passes = 64;
    result.plan.groups = 64;
    result.plan.barriers = 128;
    result.declare_ns = around(10'000);
    result.compile_ns = around(64'000);
    result.cache_hit_ns = around(2'000);
    result.phases = {{"cull", around(1'000)}, {"memory", around(40'000)}};
    bench::GraphReport report;
    report.seed = 1;
    report.compiled = {result};
    report.memory = {{"chain", 64, {1000, 2000, 900}, 1.2, 1}};
    return report;
}

std::string compare(const bench::GraphReport& before, const bench::GraphReport& now) {
    return bench::compare_reports(to_json(before), to_json(now), "old.json");
}

std::filesystem::path write(const test::TemporaryFolder& folder, const std::string& text) {
    std::ofstream(folder / "old.json") << text;
    return folder / "old.json";
}

}  // namespace

TEST_CASE("nothing has moved between a report and itself") {
    const std::string text = compare(small_report(), small_report());
    CHECK_THAT(text, Contains("0 of 11 figures moved"));
    CHECK_THAT(text, !Contains("ratio"));
}

TEST_CASE("a time beyond the spread and a count that differs have moved, what is within has not") {
    bench::GraphReport now = small_report();
    now.compiled[0].compile_ns = around(128'000);
    now.compiled[0].declare_ns = around(10'300);  // 3 %: the quartiles overlap
    now.compiled[0].phases[1].ns = around(20'000);
    now.compiled[0].plan.barriers = 127;
    const std::string text = compare(small_report(), now);
    CHECK_THAT(text, Contains("chain 64: compile, ns a pass") && Contains("2.00  slower"));
    CHECK_THAT(text, Contains("chain 64: phase memory, ns a pass") && Contains("0.50  faster"));
    CHECK_THAT(text, Contains("chain 64: barriers") && Contains("less"));
    CHECK_THAT(text, !Contains("declare"));
    CHECK_THAT(text, Contains("3 of 11 figures moved"));
}

TEST_CASE("a median that moves without the minimum is a busy machine") {
    bench::GraphReport now = small_report();
    now.compiled[0].compile_ns = {128'000, 61'000, 120'000, 140'000};
    CHECK_THAT(compare(small_report(), now), Contains("0 of 11 figures moved"));
}

TEST_CASE("what only one report has is counted, and different conditions are named") {
    bench::GraphReport now = small_report();
    now.seed = 2;
    now.memory.clear();
    const std::string text = compare(small_report(), now);
    CHECK_THAT(text, Contains("seed: 1 before, 2 now"));
    CHECK_THAT(text, Contains("not compared: 1 figures only in old.json, 0 only measured now"));
}

TEST_CASE("a file that is no report is refused with one line that says why") {
    const test::TemporaryFolder folder;
    CHECK_THROWS_AS(bench::read_report(folder / "absent.json"), InputError);
    CHECK_THROWS_AS(bench::read_report(folder.path()), InputError);
    CHECK_THROWS_WITH(bench::read_report(write(folder, "{ no")), Contains("old.json: byte ") && Contains("not JSON"));
    CHECK_THROWS_WITH(bench::read_report(write(folder, "[1, 2]")), Contains("not a report"));
    CHECK_THROWS_WITH(bench::read_report(write(folder, R"({"benchmark": "other"})")), Contains("not a report"));
    nlohmann::json newer = to_json(small_report());
    newer["version"] = 99;
    CHECK_THROWS_WITH(bench::read_report(write(folder, newer.dump())), Contains("/version: expected 2"));
}

TEST_CASE("a report with a field missing or of another type is refused") {
    const nlohmann::json now = to_json(small_report());
    for (const char* field : {"compile", "memory", "on_device", "record"}) {
        nlohmann::json damaged = now;
        damaged.erase(field);
        CHECK_THROWS_AS(bench::compare_reports(damaged, now, "old.json"), InputError);
        damaged[field] = {{"family", 3}};
        CHECK_THROWS_AS(bench::compare_reports(damaged, now, "old.json"), InputError);
    }
}
