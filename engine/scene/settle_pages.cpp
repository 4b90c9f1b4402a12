#include "engine/scene/settle_pages.h"

#include "engine/scene/gpu_model.h"

#include <algorithm>
#include <map>

namespace splice {

namespace {

// The surfels of a model that cuts ask for.
class Needs {
  public:
    explicit Needs(const GpuModel& model) : model_(&model), counts_(model.pager()->blocks()) {}

    void add(const LodCut& cut) {
        for (const CutRun& run : cut.runs) {
            if (run.inner) continue;
            const std::uint64_t bytes = model_->surfel_bytes();
            for (std::uint64_t at = run.first * bytes, end = at + run.count * bytes; at < end;) {
                const std::uint64_t block = at / SurfelPager::kBlockBytes;
                const std::uint64_t beyond = std::min((block + 1) * SurfelPager::kBlockBytes, end);
                counts_[block] += beyond - at;
                at = beyond;
            }
        }
    }

    std::vector<std::uint32_t> blocks() const {
        std::vector<std::uint32_t> needed;
        for (std::uint32_t block = 0; block < counts_.size(); ++block)
            if (counts_[block] != 0) needed.push_back(block);
        std::ranges::stable_sort(needed, std::greater(), [&](std::uint32_t block) { return counts_[block]; });
        return needed;
    }

  private:
    const GpuModel* model_;
    std::vector<std::uint64_t> counts_;  // bytes of each block
};

// Which of a model's blocks can be read until the next frame.
std::vector<bool> blocks_there(const SurfelPager& pager) {
    std::vector<bool> there(pager.blocks());
    for (std::uint32_t block = 0; block < there.size(); ++block)
        there[block] = !pager.find(block).empty();
    return there;
}

class Settler {
  public:
    Settler(const GpuModel& model, std::vector<bool> there) : model_(&model), there_(std::move(there)) {}

    // Leaves of the tree are there or not; a run consists of whole ones.
    std::uint64_t settle(LodCut& cut) const {
        std::uint64_t missing = 0;
        std::vector<CutRun> runs;
        for (const CutRun& run : cut.runs) {
            if (run.inner || is_there(run.first, run.count)) {
                runs.push_back(run);
                continue;
            }
            const auto& first_surfels = model_->hierarchy().first_surfel;
            auto leaf = std::ranges::lower_bound(model_->leaves(), run.first, {},
                                                 [&](const TreeLeaf& each) { return first_surfels[each.node]; });
            for (; leaf != model_->leaves().end(); ++leaf) {
                const std::uint32_t first = first_surfels[leaf->node];
                const std::uint32_t count = model_->hierarchy().surfel_counts[leaf->node];
                if (first >= run.first + run.count) break;
                if (!is_there(first, count)) {
                    missing += count;
                    cut.statistics.surfels -= count;
                    cut.statistics.merged_surfels += count;
                    ++cut.statistics.ellipses;
                    runs.push_back({leaf->node, 1, true, false, leaf->level});
                } else if (!runs.empty() && !runs.back().inner && runs.back().fits_point == run.fits_point &&
                           runs.back().first + runs.back().count == first) {
                    runs.back().count += count;
                } else {
                    runs.push_back({first, count, false, run.fits_point, 0});
                }
            }
        }
        cut.runs = std::move(runs);
        return missing;
    }

  private:
    bool is_there(std::uint64_t first, std::uint64_t count) const {
        const std::uint64_t bytes = model_->surfel_bytes();
        const std::uint64_t last = (first + count) * bytes - 1;
        for (std::uint64_t block = first * bytes / SurfelPager::kBlockBytes; block <= last / SurfelPager::kBlockBytes;
             ++block)
            if (!there_[block]) return false;
        return true;
    }

    const GpuModel* model_;
    std::vector<bool> there_;
};

}  // namespace

PageStats settle_pages(DrawList& draws, bool wait) {
    std::map<const GpuModel*, Needs> needs;
    for (const InstanceDraws& instance : draws.instances)
        if (instance.model->pager() != nullptr)
            needs.try_emplace(instance.model, *instance.model).first->second.add(instance.cut);
    PageStats stats;
    std::map<const GpuModel*, Settler> settlers;
    for (const auto& [model, need] : needs)
        model->pager()->want(need.blocks());
    for (const auto& [model, need] : needs) {
        SurfelPager& pager = *model->pager();
        if (wait) pager.wait();
        settlers.try_emplace(model, *model, blocks_there(pager));
        stats.limit_bytes += pager.capacity() * SurfelPager::kBlockBytes;
        stats.resident_bytes += pager.resident_bytes();
        stats.blocks_read += pager.blocks_read();
    }
    for (InstanceDraws& instance : draws.instances) {
        const auto settler = settlers.find(instance.model);
        if (settler == settlers.end()) continue;
        const CutStatistics before = instance.cut.statistics;
        stats.missing_surfels += settler->second.settle(instance.cut);
        const CutStatistics& after = instance.cut.statistics;
        draws.cut.surfels -= before.surfels - after.surfels;
        draws.cut.merged_surfels += after.merged_surfels - before.merged_surfels;
        draws.cut.ellipses += after.ellipses - before.ellipses;
        draws.surfels -= before.surfels - after.surfels;
        draws.surfels += after.ellipses - before.ellipses;
    }
    return stats;
}

}  // namespace splice
