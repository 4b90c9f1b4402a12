#include "engine/bench/graph/bench_graph.h"
#include "engine/bench/graph/report_html.h"
#include "engine/bench/graph/report_json.h"
#include "engine/bench/graph/report_text.h"
#include "engine/bench/report/svg.h"
#include "preprocess/model_format/error.h"
#include "tests/bench/markup_checker.h"

#include <catch2/catch.hpp>

#include <set>

using namespace splice;
using Catch::Contains;

namespace {

bench::GraphReport measured() {
    bench::GraphBenchOptions options;
    options.sizes = {64, 4, 128, 64};
    options.repeat = 2;
    options.use_device = false;
    return bench::bench_graph(options);
}

void add_device_results(bench::GraphReport& report) {
    report.device = "a <device> & more";
    bench::VariantResult variant;
    variant.name = "as compiled";
    report.on_device = {{"deferred", 64, 256, 256, 100, {variant}}};
    report.recorded = {{}};
}

const std::set<std::string> kFamilies{"chain", "fan", "lattice", "layered", "layered-local", "deferred"};

bool is_sample(const nlohmann::json& json) {
    const double least = json.at("minimum"), low = json.at("lower_quartile"), middle = json.at("median"),
                 high = json.at("upper_quartile");
    return json.size() == 4 && 0 <= least && least <= low && low <= middle && middle <= high;
}

}  // namespace

TEST_CASE("a measurement covers every family, each size once, in order, and says what it found") {
    const bench::GraphReport report = measured();
    const nlohmann::json json = to_json(report);
    CHECK(json.at("benchmark") == "splice-bench graph");
    CHECK(json.at("version") == 2);
    CHECK(json.at("device") == "");
    REQUIRE(json.at("compile").size() == kFamilies.size() * 3);
    std::set<std::string> families;
    for (size_t i = 0; i < json["compile"].size(); ++i) {
        const nlohmann::json& row = json["compile"][i];
        families.insert(row.at("family").get<std::string>());
        CHECK(row.at("passes") == std::array{4, 64, 128}[i % 3]);
        CHECK(row.at("recorded").get<int>() + row.at("culled").get<int>() == row.at("passes").get<int>());
        CHECK(row.at("barriers") <= row.at("barriers_one_per_access"));
        CHECK(row.at("barrier_commands") <= row.at("barriers"));
        CHECK(row.at("groups") <= row.at("recorded"));
        for (const char* field : {"declare_ns", "compile_ns", "cache_hit_ns"})
            CHECK(is_sample(row.at(field)));
        CHECK(row.at("phases").size() >= 9);
        double phases = 0;
        for (const nlohmann::json& phase : row["phases"]) {
            CHECK(is_sample(phase.at("ns")));
            phases += phase["ns"]["minimum"].get<double>();
        }
        CHECK(phases <= row["compile_ns"]["minimum"].get<double>());
    }
    CHECK(families == kFamilies);
    CHECK(json.at("growth").size() == kFamilies.size());
    for (const nlohmann::json& row : json.at("memory")) {
        CHECK(row.at("lower_bound_bytes") <= row.at("placed_bytes"));
        CHECK(row.at("worst_ratio") >= 1);
    }
    const std::string text = report_text(report);
    for (const std::string& family : kFamilies)
        CHECK_THAT(text, Contains(family));
}

TEST_CASE("the page is well-formed, shows everything and needs nothing else") {
    bench::GraphReport report = measured();
    add_device_results(report);
    const std::string page = report_html(report);
    const test::MarkupCheck check = test::check_markup(page);
    CHECK(check.problem == "");
    CHECK(report.examples.size() == 2);
    CHECK(check.elements.at("svg") == 4 + 2 * 2);
    CHECK(check.elements.at("table") == 2);
    CHECK(check.elements.count("script") == 0);
    for (const char* outside : {"src=", "href=", "url(", "@import"})
        CHECK_THAT(page, !Contains(outside));
    for (size_t at = page.find("http"); at != std::string::npos; at = page.find("http", at + 1))
        CHECK(page.compare(at, 18, "http://www.w3.org/") == 0);  // the names of the formats
    for (const std::string& family : kFamilies)
        CHECK_THAT(page, Contains(family));
    CHECK_THAT(page, Contains("a &lt;device&gt; &amp; more"));
}

TEST_CASE("the drawings show every pass and every placed resource") {
    for (const bench::ExampleGraph& example : measured().examples) {
        const std::string page = report_html(measured());
        INFO(example.family);
        CHECK(example.passes.size() == 32);
        CHECK(!example.placed.empty());
        for (const bench::DrawnPass& pass : example.passes)
            CHECK_THAT(page, Contains(">" + pass.name + "<"));
        for (const bench::PlacedResource& resource : example.placed)
            CHECK_THAT(page, Contains("<title>" + resource.name + ": groups "));
    }
}

TEST_CASE("one family and one size make a page, too") {
    bench::GraphBenchOptions options;
    options.families = {"fan"};
    options.sizes = {4};
    options.repeat = 1;
    options.use_device = false;
    const bench::GraphReport report = bench::bench_graph(options);
    CHECK(report.compiled.size() == 1);
    CHECK(report.growth.empty());
    CHECK(test::check_markup(report_html(report)).problem == "");
    CHECK_THAT(report_text(report), Contains("fan"));
}

TEST_CASE("markup in texts is escaped, and the checker of these tests sees what is not") {
    CHECK(bench::escape_markup("a<b> & \"c\"") == "a&lt;b&gt; &amp; &quot;c&quot;");
    CHECK(test::check_markup("<p>a &amp; b</p>").problem == "");
    for (const char* broken : {"<p>a & b</p>", "<p>", "<p></q>", "<p a=b></p>", "<p", "a < b"})
        CHECK(test::check_markup(broken).problem != "");
}

TEST_CASE("families and sizes that do not exist are refused") {
    bench::GraphBenchOptions options;
    options.use_device = false;
    options.families = {"chain", "tree"};
    CHECK_THROWS_WITH(bench::bench_graph(options), Contains("no family 'tree'") && Contains("layered-local"));
    options.families = {"frame"};
    CHECK_THROWS_AS(bench::bench_graph(options), UsageError);
    options.families = {};
    options.sizes = {64, 3};
    CHECK_THROWS_AS(bench::bench_graph(options), UsageError);
}
