#include "engine/passes/splat_plan.h"

#include "engine/passes/splat_buffers.h"
#include "engine/scene/surfel_store.h"

#include <algorithm>
#include <limits>
#include <span>

namespace splice {

namespace {

// What can be seen of consecutive surfels.
struct Seen {
    std::uint64_t first, end;
    bool all;  // of those, each
};

class Culler {
  public:
    Culler(const InstanceDraws& instance, const FrameSettings& settings)
        : bounds_(settings.cull_groups ? instance.surfels->bounds() : std::span<const SurfelBounds>()),
          sight_(settings.camera, settings.width, settings.height, instance.model_to_view, instance.scale,
                 instance.two_sided) {}

    // Bounds are of runs that begin where they do, groups begin where ranges do: a group has parts of two runs.
    Seen see(std::uint64_t first, std::uint64_t end) {
        if (bounds_.empty()) return {first, end, false};
        Seen seen{end, first, true};
        for (std::uint64_t run = first / kBoundedSurfels; run * kBoundedSurfels < end; ++run) {
            const Sight sight = sight_of(run);
            seen.all = seen.all && sight != Sight::kSome;
            if (sight == Sight::kNone) continue;
            seen.first = std::min(seen.first, std::max(first, run * kBoundedSurfels));
            seen.end = std::min(end, (run + 1) * kBoundedSurfels);
        }
        return seen;
    }

  private:
    // The next group begins in the run that the last one ended in.
    Sight sight_of(std::uint64_t run) {
        if (run != last_run_) last_sight_ = sight_.of(bounds_[run]);
        last_run_ = run;
        return last_sight_;
    }

    std::span<const SurfelBounds> bounds_;
    SurfelSight sight_;
    std::uint64_t last_run_ = std::numeric_limits<std::uint64_t>::max();
    Sight last_sight_ = Sight::kSome;
};

class Planner {
  public:
    Planner(std::uint64_t most_groups, const FrameSettings& settings) : most_(most_groups), settings_(settings) {
        plan_.batches.emplace_back();
    }

    void add_ranges(const InstanceDraws& instance, const std::vector<DrawRange>& ranges, Technique technique) {
        Culler culler(instance, settings_);
        for (const DrawRange& range : ranges)
            for (const SurfelChunk& chunk : instance.surfels->chunks()) {
                const std::uint64_t first = std::max(range.first, chunk.first);
                const std::uint64_t end = std::min(range.first + range.count, chunk.first + chunk.count);
                for (std::uint64_t next = first; next < end; next += kTileGroup) {
                    const std::uint64_t stop = std::min<std::uint64_t>(end, next + kTileGroup);
                    const Seen seen = culler.see(next, stop);
                    const std::uint64_t count = seen.first < seen.end ? seen.end - seen.first : 0;
                    plan_.counts.culled_surfels += stop - next - count;
                    if (count == 0) continue;
                    add_group(instance, chunk.set,
                              {static_cast<std::uint32_t>(seen.first - chunk.first),
                               static_cast<std::uint32_t>(count) | (seen.all ? kGroupShows : 0u)},
                              technique);
                    plan_.counts.surfels += count;
                    plan_.counts.certain_groups += seen.all ? 1 : 0;
                }
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
        ++plan_.counts.groups;
    }

    std::uint64_t most_;
    const FrameSettings& settings_;
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

SplatPlan plan_splats(const DrawList& draws, const Techniques& techniques, std::uint64_t most_groups,
                      const FrameSettings& settings) {
    Planner planner(most_groups, settings);
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
