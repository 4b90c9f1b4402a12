#include "engine/bench/graph/measure_device.h"

#include "engine/bench/graph/device_graph.h"
#include "engine/bench/graph/painter.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace splice::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kObjects = 16;  // draws in a pass that writes depth

double us_since(Clock::time_point start) {
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

struct Variant {
    const char* name;
    bool cull = true, merge = true, alias = true, batch_barriers = true;
    std::optional<uint64_t> random_order = {};
};

constexpr Variant kVariants[] = {
    {.name = "as compiled"},
    {.name = "no culling", .cull = false},
    {.name = "no merging", .merge = false},
    {.name = "no aliasing", .alias = false},
    {.name = "one barrier an access", .batch_barriers = false},
    {.name = "random order", .random_order = 1},
    {.name = "none of these", .cull = false, .merge = false, .alias = false, .batch_barriers = false},
};

graph::ExecutorOptions executor_options(const Variant& variant) {
    graph::ExecutorOptions options;
    options.timestamps = false;
    options.cull = variant.cull;
    options.merge = variant.merge;
    options.alias = variant.alias;
    options.batch_barriers = variant.batch_barriers;
    options.random_order = variant.random_order;
    return options;
}

struct RunningVariant {
    VariantResult result;
    std::unique_ptr<DeviceGraph> graph;
    std::vector<double> frame_ms, record_us;
};

void run_frame(gpu::Device& device, RunningVariant& variant) {
    double record_us = 0;
    const Clock::time_point start = Clock::now();
    device.submit_and_wait([&](VkCommandBuffer commands) {
        const Clock::time_point record_start = Clock::now();
        variant.graph->record(commands);
        record_us = us_since(record_start);
    });
    variant.frame_ms.push_back(us_since(start) / 1000);
    variant.record_us.push_back(record_us);
}

}  // namespace

DeviceWorkload painted_workload(gpu::Device& device, const Family& family, uint32_t passes, uint32_t width,
                                uint32_t height, uint64_t seed) {
    FamilyOptions options;
    options.passes = passes;
    options.seed = seed;
    // Deferred views have one size each, like a screen; elsewhere every pass has its own.
    options.sizes = family.name == "deferred" ? ImageSizes::equal : ImageSizes::log_uniform;
    options.width = width;
    options.height = height;
    options.log2_max_pixels = std::log2(static_cast<double>(width) * height);
    options.log2_min_pixels = options.log2_max_pixels - 8;
    const auto shaders = std::make_shared<PassShaders>(device);
    const auto make = [&device, declare = family.declare, options, shaders] {
        const auto painter = std::make_shared<Painter>(device, *shaders, kObjects);
        FamilyOptions painted = options;
        painted.paint = [painter](graph::Graph& graph, graph::Pass& pass) { painter->paint(graph, pass); };
        // The shaders live as long as the function that draws with them.
        return [declare, painted, shaders](graph::Graph& graph) { declare(graph, painted); };
    };
    return {std::string(family.name), passes, width, height, make};
}

DeviceResult measure_device(gpu::Device& device, const DeviceWorkload& workload, uint32_t rounds,
                            const std::function<void(std::string_view)>& progress) {
    DeviceResult result{workload.family, workload.passes, workload.width, workload.height, 0, {}};
    std::vector<RunningVariant> variants;
    std::vector<std::byte> reference;
    for (const Variant& variant : kVariants) {
        progress(fmt::format("{} of {} passes on the device: {}", workload.family, workload.passes, variant.name));
        RunningVariant running;
        running.result.name = variant.name;
        running.graph = std::make_unique<DeviceGraph>(device, workload.make(), executor_options(variant));
        run_frame(device, running);
        const std::vector<std::byte> bytes = running.graph->results();
        if (variants.empty()) {
            reference = bytes;
            result.first_frame_ms = running.frame_ms.front();
        }
        running.result.same_image = bytes == reference;
        const graph::ExecutorStatistics& statistics = running.graph->executor().statistics();
        running.result.render_passes = statistics.render_passes;
        running.result.barrier_commands = statistics.barrier_commands;
        running.result.barriers = statistics.image_barriers + statistics.buffer_barriers;
        running.result.transient_bytes = statistics.transient_bytes;
        running.frame_ms.clear();
        running.record_us.clear();
        variants.push_back(std::move(running));
    }
    for (uint32_t round = 0; round < rounds; ++round) {
        progress(fmt::format("{} of {} passes on the device, round {} of {}", workload.family, workload.passes,
                             round + 1, rounds));
        for (size_t i = 0; i < variants.size(); ++i)
            run_frame(device, variants[(i + round) % variants.size()]);  // nobody always comes after the same one
    }
    for (RunningVariant& variant : variants) {
        variant.result.frame_ms = summarise(variant.frame_ms);
        variant.result.record_us = summarise(variant.record_us);
        result.variants.push_back(variant.result);
    }
    return result;
}

}  // namespace splice::bench
