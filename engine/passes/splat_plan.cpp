#include "engine/passes/splat_plan.h"

#include "engine/passes/splat_buffers.h"
#include "engine/scene/surfel_store.h"

#include <algorithm>

namespace splice {

namespace {

class Planner {
  public:
    explicit Planner(std::uint64_t most_groups) : most_(most_groups), batches_(1) {}

    void add_ranges(const InstanceDraws& instance, const std::vector<DrawRange>& ranges, Technique technique) {
        for (const DrawRange& range : ranges)
            for (const SurfelChunk& chunk : instance.surfels->chunks()) {
                const std::uint64_t first = std::max(range.first, chunk.first);
                const std::uint64_t end = std::min(range.first + range.count, chunk.first + chunk.count);
                if (first < end) add_surfels(instance, chunk.set, first - chunk.first, end - first, technique);
            }
    }
    std::vector<SplatBatch> take() { return std::move(batches_); }

  private:
    void add_surfels(const InstanceDraws& instance, VkDescriptorSet set, std::uint64_t first, std::uint64_t count,
                     Technique technique) {
        while (count > 0) {
            if (batches_.back().groups == most_) batches_.emplace_back();
            SplatBatch& batch = batches_.back();
            const std::uint64_t part = std::min(count, (most_ - batch.groups) * kTileGroup);
            const std::uint64_t groups = (part + kTileGroup - 1) / kTileGroup;
            batch.jobs.push_back({&instance, set, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(part),
                                  static_cast<std::uint32_t>(batch.groups), technique});
            GroupRange& range = batch.ranges[static_cast<std::size_t>(technique)];
            if (range.count == 0) range.first = static_cast<std::uint32_t>(batch.groups);
            range.count += static_cast<std::uint32_t>(groups);
            batch.groups += groups;
            first += part;
            count -= part;
        }
    }

    std::uint64_t most_;
    std::vector<SplatBatch> batches_;
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

std::vector<SplatBatch> plan_splats(const DrawList& draws, const Techniques& techniques, std::uint64_t most_groups) {
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
