#include "engine/bench/graph/measure_record.h"

#include "engine/bench/graph/device_graph.h"
#include "engine/bench/graph/families.h"
#include "engine/bench/graph/hand_written_deferred.h"
#include "engine/bench/graph/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string_view>

namespace splice::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kSide = 64;  // pixels: recording does not depend on the size, executing does

double record_us(gpu::Device& device, const std::function<void(VkCommandBuffer)>& record) {
    double us = 0;
    device.submit_and_wait([&](VkCommandBuffer commands) {
        const Clock::time_point start = Clock::now();
        record(commands);
        us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    });
    return us;
}

std::function<void(graph::Graph&)> declare_view(const std::shared_ptr<Painter>& painter) {
    const std::vector<Family> all = families();
    const auto deferred =
        std::find_if(all.begin(), all.end(), [](const Family& one) { return one.name == "deferred"; });
    FamilyOptions options;
    options.passes = kDeferredViewPasses;
    options.width = options.height = kSide;
    options.paint = [painter](graph::Graph& graph, graph::Pass& pass) { painter->paint(graph, pass); };
    return [declare = deferred->declare, options](graph::Graph& graph) { declare(graph, options); };
}

RecordGrowthResult measure_growth_of(gpu::Device& device, const Family& family, const FamilyOptions& options,
                                     uint32_t rounds) {
    graph::ExecutorOptions executor_options;
    executor_options.timestamps = false;
    DeviceGraph graph(
        device, [&](graph::Graph& anew) { family.declare(anew, options); }, executor_options);
    const auto record = [&](VkCommandBuffer commands) { graph.record(commands); };
    record_us(device, record);
    std::vector<double> recorded, hits;
    for (uint32_t round = 0; round < rounds; ++round) {
        recorded.push_back(record_us(device, record));
        graph.declare_anew();
        const Clock::time_point start = Clock::now();
        graph.prepare();
        hits.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
    const graph::ExecutorStatistics& statistics = graph.executor().statistics();
    return {std::string(family.name), options.passes,
            statistics.render_passes, statistics.image_barriers + statistics.buffer_barriers,
            summarise(recorded),      summarise(hits)};
}

}  // namespace

std::vector<RecordGrowthResult> measure_record_growth(gpu::Device& device, const RecordGrowthMeasurement& measurement) {
    std::vector<RecordGrowthResult> results;
    for (const Family& family : measurement.families) {
        for (const uint32_t passes : measurement.sizes) {
            measurement.progress(fmt::format("record {} of {} passes", family.name, passes));
            FamilyOptions options;
            options.passes = passes;
            options.seed = measurement.seed;
            options.sizes = ImageSizes::log_uniform;
            options.log2_min_pixels = 4;
            options.log2_max_pixels = 2 * std::log2(static_cast<double>(kSide));
            options.paint = [](graph::Graph&, graph::Pass& pass) { pass.record([](const graph::PassContext&) {}); };
            results.push_back(measure_growth_of(device, family, options, measurement.rounds));
        }
    }
    return results;
}

RecordResult measure_record(gpu::Device& device, uint32_t objects, uint32_t rounds) {
    const PassShaders shaders(device);
    HandWrittenDeferred by_hand(device, shaders, DeferredView::of(kDeferredViewPasses), kSide, kSide, objects);
    graph::ExecutorOptions options;
    options.timestamps = false;  // nor does the twin write any
    DeviceGraph kept(device, declare_view(std::make_shared<Painter>(device, shaders, objects)), options);
    DeviceGraph anew(device, declare_view(std::make_shared<Painter>(device, shaders, objects)), options);

    const std::array<std::function<void(VkCommandBuffer)>, 3> ways{
        [&](VkCommandBuffer commands) { by_hand.record(commands); },
        [&](VkCommandBuffer commands) { kept.record(commands); },
        [&](VkCommandBuffer commands) {
            anew.declare_anew();
            anew.record(commands);
        }};
    for (const auto& way : ways)
        record_us(device, way);  // pipelines, descriptor sets, the plan
    std::array<size_t, 3> order{0, 1, 2};
    std::array<std::vector<double>, 3> us;
    std::vector<double> overhead, overhead_anew;
    for (uint32_t round = 0; round < rounds; ++round) {
        for (const size_t way : order)
            us[way].push_back(record_us(device, ways[way]));
        std::next_permutation(order.begin(), order.end());  // nobody always comes after the same one
        overhead.push_back(us[1].back() / us[0].back() - 1);
        overhead_anew.push_back(us[2].back() / us[0].back() - 1);
    }

    const graph::ExecutorStatistics& statistics = kept.executor().statistics();
    const RecordedCounts through_graph{statistics.passes, statistics.render_passes, statistics.barrier_commands,
                                       statistics.image_barriers + statistics.buffer_barriers};
    RecordResult result;
    result.passes = kDeferredViewPasses;
    result.objects = objects;
    result.commands = by_hand.commands();
    result.by_hand_us = summarise(us[0]);
    result.through_graph_us = summarise(us[1]);
    result.declared_anew_us = summarise(us[2]);
    result.overhead = summarise(overhead).median;
    result.overhead_declared_anew = summarise(overhead_anew).median;
    result.same_commands = through_graph == by_hand.counts();
    const std::vector<std::byte> picture = by_hand.results();
    result.same_image = picture == kept.results() && picture == anew.results();
    return result;
}

}  // namespace splice::bench
