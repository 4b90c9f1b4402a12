#include "engine/bench/graph/measure_compile.h"

#include "engine/render_graph/compile.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

namespace splice::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kGrowthFrom = 64, kGrowthTo = 4096;  // passes

double ns_since(Clock::time_point start) {
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

FamilyOptions declaration_options(uint32_t passes, uint64_t seed) {
    FamilyOptions options;
    options.passes = passes;
    options.seed = seed;
    options.sizes = ImageSizes::log_uniform;
    // Passes of a real frame carry a function, and what it needs.
    options.paint = [](graph::Graph& graph, graph::Pass& pass) {
        pass.record([&graph, index = pass.index()](const graph::PassContext&) { (void)graph.pass_name(index); });
    };
    return options;
}

/// A graph under measurement with the times so far.
class Case {
  public:
    Case(const Family& family, const FamilyOptions& options) : family_(family), options_(options) {
        family_.declare(graph_, options_);
        requirements_ = memory_requirements(graph_.declaration());
        compile_options_.memory = [this](uint32_t resource, const graph::PlannedResource&) {
            return requirements_[resource];
        };
        compiled_key_ = graph_.key();
        result_.family = family_.name;
        result_.passes = static_cast<uint32_t>(graph_.declaration().passes.size());
        result_.resources = static_cast<uint32_t>(graph_.declaration().resources.size());
        result_.accesses = static_cast<uint32_t>(graph_.declaration().accesses.size());
        result_.plan = graph::measure(graph_, graph::compile(graph_, compile_options_));
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    void run_once() {
        Clock::time_point start = Clock::now();
        graph_.clear();
        family_.declare(graph_, options_);
        declare_ns_.push_back(ns_since(start));

        graph::CompileTimings timings;
        start = Clock::now();
        const graph::Plan plan = graph::compile(graph_, compile_options_, &timings);
        compile_ns_.push_back(ns_since(start));
        phase_ns_.resize(timings.phases.size());
        for (size_t i = 0; i < timings.phases.size(); ++i) {
            result_.phases.resize(timings.phases.size());
            result_.phases[i].name = timings.phases[i].name;
            phase_ns_[i].push_back(static_cast<double>(timings.phases[i].nanoseconds));
        }

        start = Clock::now();
        const bool hit = compiled_key_ == graph_.key();
        const double taken = ns_since(start);
        if (hit) hit_ns_.push_back(taken);
    }

    CompileResult result() {
        result_.declare_ns = summarise(declare_ns_);
        result_.compile_ns = summarise(compile_ns_);
        result_.cache_hit_ns = summarise(hit_ns_);
        for (size_t i = 0; i < phase_ns_.size(); ++i)
            result_.phases[i].ns = summarise(phase_ns_[i]);
        return result_;
    }

  private:
    Family family_;
    FamilyOptions options_;
    graph::Graph graph_;
    std::vector<graph::MemoryRequirement> requirements_;
    graph::CompileOptions compile_options_;
    graph::DeclarationKey compiled_key_;
    CompileResult result_;
    std::vector<double> declare_ns_, compile_ns_, hit_ns_;
    std::vector<std::vector<double>> phase_ns_;
};

}  // namespace

std::vector<CompileResult> measure_compile(const CompileMeasurement& measurement) {
    std::vector<std::unique_ptr<Case>> cases;
    for (const Family& family : measurement.families) {
        for (const uint32_t passes : measurement.sizes) {
            measurement.progress(fmt::format("declare {} of {} passes", family.name, passes));
            cases.push_back(std::make_unique<Case>(family, declaration_options(passes, measurement.seed)));
        }
    }
    for (uint32_t round = 0; round < measurement.repeat; ++round) {
        measurement.progress(fmt::format("compile, round {} of {}", round + 1, measurement.repeat));
        for (const auto& one : cases)
            one->run_once();
    }
    std::vector<CompileResult> results;
    for (const auto& one : cases)
        results.push_back(one->result());
    return results;
}

std::vector<Growth> fit_growth(const std::vector<CompileResult>& results) {
    std::vector<Growth> all;
    for (size_t begin = 0, end = 0; begin < results.size(); begin = end) {
        std::vector<std::pair<double, double>> points;
        Growth growth{results[begin].family, 0, 0, 0};
        for (end = begin; end < results.size() && results[end].family == growth.family; ++end) {
            const CompileResult& result = results[end];
            if (result.passes < kGrowthFrom - kGrowthFrom / 8 || result.passes > kGrowthTo) continue;
            points.emplace_back(result.passes, result.compile_ns.median);
            if (growth.from == 0) growth.from = result.passes;
            growth.to = result.passes;
        }
        if (growth.from == growth.to) continue;
        growth.exponent = growth_exponent(points);
        all.push_back(growth);
    }
    return all;
}

std::vector<MemoryResult> measure_memory(const CompileMeasurement& measurement) {
    std::vector<MemoryResult> results;
    for (const Family& family : measurement.families) {
        for (const uint32_t passes : measurement.sizes) {
            measurement.progress(fmt::format("memory of {}, {} passes", family.name, passes));
            MemoryResult result;
            result.family = family.name;
            for (uint32_t i = 0; i < measurement.memory_seeds; ++i) {
                const uint64_t seed = measurement.seed + i;
                graph::Graph graph;
                family.declare(graph, declaration_options(passes, seed));
                const auto requirements = memory_requirements(graph.declaration());
                graph::CompileOptions options;
                options.memory = [&](uint32_t resource, const graph::PlannedResource&) {
                    return requirements[resource];
                };
                const MemoryFigures use = memory_use(graph.declaration(), graph::compile(graph, options), requirements);
                if (i == 0) {
                    result.passes = static_cast<uint32_t>(graph.declaration().passes.size());
                    result.use = use;
                }
                const double ratio =
                    use.lower_bound == 0 ? 1 : static_cast<double>(use.placed) / static_cast<double>(use.lower_bound);
                if (ratio <= result.worst_ratio) continue;
                result.worst_ratio = ratio;
                result.worst_seed = seed;
            }
            results.push_back(result);
        }
    }
    return results;
}

}  // namespace splice::bench
