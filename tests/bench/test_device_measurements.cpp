// What the benchmark runs on a device is right before it is timed: no message of the validation layers, the same bytes
// whatever is switched off, and a twin by hand that does the same.
#include "engine/bench/graph/families.h"
#include "engine/bench/graph/family_frame.h"
#include "engine/bench/graph/hand_written_deferred.h"
#include "engine/bench/graph/measure_compile.h"
#include "engine/bench/graph/measure_device.h"
#include "engine/bench/graph/measure_record.h"
#include "tests/render_graph/device_fixture.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace splice;

TEST_CASE("frames of every family have the same bytes under all switches") {
    test::ValidatedDevice validated;
    for (const bench::Family& family : bench::families()) {
        INFO(family.name);
        const auto workload = bench::painted_workload(validated.device, family, 40, 64, 64, 5);
        const bench::DeviceResult result = bench::measure_device(validated.device, workload, 2, [](auto) {});
        REQUIRE(result.variants.size() == 7);
        for (const bench::VariantResult& variant : result.variants) {
            INFO(variant.name);
            CHECK(variant.same_image);
            CHECK(variant.barriers >= result.variants[0].barriers);
            CHECK(variant.render_passes >= result.variants[0].render_passes);
            CHECK(variant.transient_bytes > 0);
        }
        CHECK(validated.complaints() == "");
    }
}

TEST_CASE("the twin by hand records the same commands and leaves the same picture") {
    test::ValidatedDevice validated;
    for (const uint32_t objects : {1U, 5U}) {
        const bench::RecordResult result = bench::measure_record(validated.device, objects, 1);
        CHECK(result.same_commands);
        CHECK(result.same_image);
        CHECK(result.passes == 32);
    }
    CHECK(validated.complaints() == "");
}

TEST_CASE("recording is measured against size, and a graph declared anew finds its plan") {
    test::ValidatedDevice validated;
    const bench::RecordGrowthMeasurement measurement{.families = bench::families(), .sizes = {4, 48}, .rounds = 3};
    const auto results = bench::measure_record_growth(validated.device, measurement);
    REQUIRE(results.size() == 2 * measurement.families.size());
    for (size_t i = 0; i < results.size(); ++i) {
        INFO(results[i].family);
        CHECK(results[i].family == measurement.families[i / 2].name);
        CHECK(results[i].passes == measurement.sizes[i % 2]);
        CHECK(results[i].render_passes > 0);
        CHECK(results[i].render_passes <= results[i].passes);
        CHECK(results[i].record_us.median > 0);
        CHECK(results[i].hit_us.median >= 0);
    }
    CHECK(validated.complaints(test::is_unseen_read) == "");
}

TEST_CASE("the twin's picture shows something, and views of other shapes work") {
    test::ValidatedDevice validated;
    const bench::PassShaders shaders(validated.device);
    for (const uint32_t passes : {8U, 15U, 32U}) {
        bench::DeferredView view = bench::DeferredView::of(passes);
        view.lights = std::max(view.lights, 1U);
        bench::HandWrittenDeferred twin(validated.device, shaders, view, 48, 32, 3);
        validated.device.submit_and_wait([&](VkCommandBuffer commands) { twin.record(commands); });
        const std::vector<std::byte> picture = twin.results();
        CHECK(picture.size() == 48 * 32 * 4);
        CHECK(std::set<std::byte>(picture.begin(), picture.end()).size() > 20);
    }
    CHECK(validated.complaints() == "");
}

TEST_CASE("the renderer's own frame is a family of whole views and merges into one render pass a view") {
    test::ValidatedDevice validated;
    bench::CompileMeasurement measurement;
    measurement.families = {bench::frame_family(validated.device)};
    measurement.sizes = {4, 14, 25};
    measurement.repeat = 1;
    const std::vector<bench::CompileResult> results = bench::measure_compile(measurement);
    REQUIRE(results.size() == 3);
    const uint32_t views[] = {1, 2, 5};
    for (size_t i = 0; i < 3; ++i) {
        CHECK(results[i].passes == views[i] * 5);
        CHECK(results[i].plan.culled == 0);
        CHECK(results[i].plan.merged_groups == views[i]);
        CHECK(results[i].plan.groups == views[i] * 2);
    }
}

TEST_CASE("the renderer's own frame has the same bytes under all switches") {
    test::ValidatedDevice validated;
    const auto workload = bench::frame_workload(validated.device, 64, 48);
    const bench::DeviceResult result = bench::measure_device(validated.device, workload, 1, [](auto) {});
    for (const bench::VariantResult& variant : result.variants)
        CHECK(variant.same_image);
    CHECK(validated.complaints() == "");
}
