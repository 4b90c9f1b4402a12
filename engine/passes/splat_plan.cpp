#include "engine/passes/splat_plan.h"

#include "engine/passes/splat_buffers.h"
#include "engine/scene/surfel_store.h"

#include <algorithm>

namespace splice {

namespace {

class Planner {
  public:
    explicit Planner(std::uint64_t most_groups) : most_(most_groups) { plan_.batches.emplace_back(); }

    void add_ranges(const InstanceDraws& instance, const std::vector<DrawRange>& ranges, Technique technique) {
        for (const DrawRange& range : ranges)
            for (const SurfelChunk& chunk : instance.surfels->chunks()) {
                const std::uint64_t first = std::max(range.first, chunk.first);
                const std::uint64_t end = std::min(range.first + range.count, chunk.first + chunk.count);
                for (std::uint64_t next = first; next < end; next += kTileGroup)
                    add_group(instance, chunk.set,
                              {static_cast<std::uint32_t>(next - chunk.first),
                               static_cast<std::uint32_t>(std::min<std::uint64_t>(end - next, kTileGroup))},
                              technique);
            }
    }
    SplatPlan take() { return std::move(plan_); }

  private:
    void add_group(const InstanceDraws& instance, VkDescriptorSet set, const SplatGroup& group, Technique technique) {
        if (plan_.batches.back().groups == most_) plan_.batches.emplace_back();
        SplatBatch& batch = plan_.batches.back();
        const auto number = static_cast<std::uint32_t>(batch.groups);
        const auto continues = [&](const SplatJob& job) {
            return job.instance == &instance && job.surfels == set && job.technique == technique;
        };
        if (batch.jobs.empty() || !continues(batch.jobs.back()))
            batch.jobs.push_back(
                {&instance, set, 0, number, static_cast<std::uint32_t>(plan_.groups.size()), technique});
        ++batch.jobs.back().groups;
        GroupRange& range = batch.ranges[static_cast<std::size_t>(technique)];
        if (range.count == 0) range.first = number;
        ++range.count;
        ++batch.groups;
        plan_.groups.push_back(group);
    }

    std::uint64_t most_;
    SplatPlan plan_;
};

}  // namespace

Backend backend_of(Technique technique) {
    switch (technique) {
        case Technique::kRaster:
            return Backend::kRaster;
        case Technique::kPoint:
            return Backend::kPoint;
        default:
            return Backend::kTile;
    }
}

SplatPlan plan_splats(const DrawList& draws, const Techniques& techniques, std::uint64_t most_groups) {
    Planner planner(most_groups);
    for (const Technique technique : {Technique::kTile, Technique::kRaster, Technique::kPoint})
        for (const InstanceDraws& instance : draws.instances) {
            if (techniques.others == technique) {
                planner.add_ranges(instance, instance.sprites, technique);
                planner.add_ranges(instance, instance.quads, technique);
            }
            if (techniques.small == technique) planner.add_ranges(instance, instance.small, technique);
        }
    return planner.take();
}

}  // namespace splice
