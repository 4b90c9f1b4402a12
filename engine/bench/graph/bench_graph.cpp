#include "engine/bench/graph/bench_graph.h"

#include "engine/bench/graph/example_graph.h"
#include "engine/bench/graph/families.h"
#include "engine/bench/graph/family_frame.h"
#include "engine/bench/graph/measure_compile.h"
#include "engine/bench/graph/measure_device.h"
#include "engine/bench/graph/measure_record.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>

namespace splice::bench {
namespace {

constexpr const char* kFrameFamily = "frame";
constexpr uint32_t kDevicePasses = 64, kDeviceSide = 256;
constexpr uint32_t kFrameSide = 512;
constexpr uint32_t kRecordRounds = 10;  // times options.repeat: recording is short
constexpr uint32_t kExamplePasses = 32;

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(std::min(line.find(": ") + 2, line.size()));
    }
    return "unknown processor";
}

struct Gpu {
    explicit Gpu(const gpu::DeviceChoice& choice) : device(instance, {.choice = choice}) {}
    gpu::Instance instance;
    gpu::Device device;
};

bool wanted(const GraphBenchOptions& options, std::string_view name) {
    return options.families.empty() ||
           std::find(options.families.begin(), options.families.end(), name) != options.families.end();
}

void check(const GraphBenchOptions& options) {
    const std::vector<std::string> names = family_names();
    for (const std::string& family : options.families) {
        if (std::find(names.begin(), names.end(), family) == names.end()) {
            std::string all;
            for (const std::string& name : names)
                all += (all.empty() ? "" : ", ") + name;
            throw UsageError("--families: no family '" + family + "'; there are " + all);
        }
    }
    if (options.sizes.empty() || *std::min_element(options.sizes.begin(), options.sizes.end()) < 4)
        throw UsageError("--sizes: at least 4 passes");
    if (!options.use_device && options.families == std::vector<std::string>{kFrameFamily})
        throw UsageError("--families frame: takes a device, so not with --no-device");
}

ExampleGraph example_of(const Family& family, uint64_t seed) {
    FamilyOptions options;
    options.passes = kExamplePasses;
    options.seed = seed;
    options.sizes = ImageSizes::log_uniform;
    options.log2_min_pixels = 18;  // sizes like a screen's: small ones would be too thin to see
    options.log2_max_pixels = 22;
    if (family.name == kFrameFamily) options.passes = 2 * kFrameViewPasses;
    graph::Graph graph;
    family.declare(graph, options);
    return example_graph(graph, std::string(family.name));
}

void run_on_device(const GraphBenchOptions& options, const std::vector<Family>& chosen,
                   const std::vector<uint32_t>& sizes, gpu::Device& device, GraphReport& report) {
    for (const Family& family : chosen) {
        const DeviceWorkload workload =
            family.name == kFrameFamily
                ? frame_workload(device, kFrameSide, kFrameSide)
                : painted_workload(device, family, kDevicePasses, kDeviceSide, kDeviceSide, options.seed);
        report.on_device.push_back(measure_device(device, workload, options.repeat, options.progress));
    }
    RecordGrowthMeasurement growth;
    std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(growth.families),
                 [](const Family& family) { return family.name != kFrameFamily; });
    growth.sizes = sizes;
    growth.seed = options.seed;
    growth.rounds = options.repeat;
    growth.progress = options.progress;
    report.record_growth = measure_record_growth(device, growth);
    for (const uint32_t objects : {1U, 16U, 64U}) {
        options.progress("recording through the graph and by hand");
        report.recorded.push_back(measure_record(device, objects, kRecordRounds * options.repeat));
    }
}

}  // namespace

std::vector<std::string> family_names() {
    std::vector<std::string> names;
    for (const Family& family : families())
        names.emplace_back(family.name);
    names.emplace_back(kFrameFamily);
    return names;
}

GraphReport bench_graph(const GraphBenchOptions& options) {
    check(options);
    GraphReport report;
    report.seed = options.seed;
    report.repeat = options.repeat;
    report.processor = processor_name();
    std::unique_ptr<Gpu> gpu;
    if (options.use_device) {
        gpu = std::make_unique<Gpu>(options.device);
        report.device = gpu->device.info().name;
    }
    CompileMeasurement measurement;
    measurement.sizes = options.sizes;
    std::sort(measurement.sizes.begin(), measurement.sizes.end());
    measurement.sizes.erase(std::unique(measurement.sizes.begin(), measurement.sizes.end()), measurement.sizes.end());
    measurement.seed = options.seed;
    measurement.repeat = options.repeat;
    measurement.progress = options.progress;
    for (const Family& family : families()) {
        if (wanted(options, family.name)) measurement.families.push_back(family);
    }
    if (gpu && wanted(options, kFrameFamily)) measurement.families.push_back(frame_family(gpu->device));

    report.compiled = measure_compile(measurement);
    report.growth = fit_growth(report.compiled);
    report.memory = measure_memory(measurement);
    for (const Family& family : measurement.families) {
        // The others are regular, or too wide to draw.
        if (family.name == "layered-local" || family.name == "deferred" || family.name == kFrameFamily)
            report.examples.push_back(example_of(family, options.seed));
    }
    if (gpu) run_on_device(options, measurement.families, measurement.sizes, gpu->device, report);
    options.progress("");
    return report;
}

}  // namespace splice::bench
