// Barriers between groups. The uses of a resource fall into runs - one writing group, or consecutive groups that only
// read it in one layout - and one barrier before each run waits for the run before. All barriers before a group are one
// batch.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>

namespace splice::graph {
namespace {

struct Run {
    uint32_t first_group = none;
    Scope entry, exit;
    VkImageLayout entry_layout = VK_IMAGE_LAYOUT_UNDEFINED, exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool writes = false, needs_contents = true;
};

Run first_run(std::span<const GroupUse> uses) {
    Run run{uses[0].group,       uses[0].entry,  uses[0].exit,          uses[0].entry_layout,
            uses[0].exit_layout, uses[0].writes, uses[0].needs_contents};
    if (run.writes) return run;
    for (size_t i = 1; i < uses.size() && !uses[i].writes && uses[i].entry_layout == run.exit_layout; ++i) {
        run.entry |= uses[i].entry;
        run.exit |= uses[i].exit;
    }
    return run;
}

size_t run_length(std::span<const GroupUse> uses) {
    size_t length = 1;
    if (uses[0].writes) return length;
    while (length < uses.size() && !uses[length].writes && uses[length].entry_layout == uses[0].exit_layout)
        ++length;
    return length;
}

Scope waited_for(const Scope& scope) {
    return {scope.stages, write_access(scope.access)};
}

class BarrierPlanner {
  public:
    explicit BarrierPlanner(Compilation& compilation) : compilation_(compilation) {}

    void run() {
        const auto resources = static_cast<uint32_t>(compilation_.declaration.resources.size());
        find_last_runs();
        for (uint32_t resource = 0; resource < resources; ++resource)
            plan_resource(resource);
        distribute();
    }

  private:
    struct Placed {
        uint32_t group;
        ImageBarrier barrier;
    };

    void find_last_runs() {
        last_exit_.resize(compilation_.declaration.resources.size());
        for (uint32_t resource = 0; resource < last_exit_.size(); ++resource) {
            std::span<const GroupUse> uses = compilation_.uses_of_resource(resource);
            while (!uses.empty()) {
                last_exit_[resource] = first_run(uses).exit;
                uses = uses.subspan(run_length(uses));
            }
        }
    }

    /// Whatever used the memory of a transient resource before its first use: those that had its bytes last, itself in
    /// the frame before among them.
    Scope previous_occupants(uint32_t resource) const {
        if (compilation_.plan.resources[resource].heap == none) return waited_for(last_exit_[resource]);
        Scope scope;
        for (const uint32_t other : slice(compilation_.occupants, compilation_.occupants_before[resource])) {
            scope |= waited_for(last_exit_[other]);
        }
        return scope;
    }

    void plan_resource(uint32_t resource) {
        const ResourceDeclaration& declared = compilation_.declaration.resources[resource];
        std::span<const GroupUse> uses = compilation_.uses_of_resource(resource);
        Run before;
        if (declared.imported) {
            before.exit = declared.import.before.scope;
            if (declared.kind == ResourceKind::image) before.exit_layout = declared.import.before.layout;
            before.writes = write_access(before.exit.access) != 0;
        } else {
            if (uses.empty()) return;
            before.exit = previous_occupants(resource);
            before.writes = true;
        }
        const Run after = declared.imported ? outside(resource, before, uses) : Run{};
        while (!uses.empty()) {
            Run next = first_run(uses);
            if (!next.needs_contents) before.exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
            uses = uses.subspan(run_length(uses));
            const bool joins = uses.empty() && !next.writes && !after.writes && next.exit_layout == after.entry_layout;
            if (joins) next.entry |= after.entry;  // the readers outside belong to the last run
            // Without a barrier, the next one must wait for the readers outside as well.
            if (!connect(resource, before, next)) next.exit.stages |= before.exit.stages;
            before = next;
            if (joins) return;
        }
        if (after.first_group != none) connect(resource, before, after);
    }

    /// What comes after the frame as a run of its own; no group if nothing does.
    Run outside(uint32_t resource, const Run& before, std::span<const GroupUse> uses) const {
        const ResourceDeclaration& declared = compilation_.declaration.resources[resource];
        const ExternalUse& after = declared.import.after;
        Run run;
        if (after == external::none()) return run;
        run.first_group = static_cast<uint32_t>(compilation_.plan.groups.size());
        run.entry = after.scope;
        run.writes = write_access(after.scope.access) != 0;
        run.entry_layout = after.layout;
        const bool image = declared.kind == ResourceKind::image;
        if (!image || after.layout == VK_IMAGE_LAYOUT_UNDEFINED) {
            run.entry_layout = uses.empty() ? before.exit_layout : uses.back().exit_layout;
        }
        return run;
    }

    /// Plans the barrier between two runs if one is needed.
    bool connect(uint32_t resource, const Run& before, const Run& next) {
        const bool image = compilation_.declaration.resources[resource].kind == ResourceKind::image;
        const bool transition = image && before.exit_layout != next.entry_layout;
        bool hazard = before.writes || next.writes;
        // Readers outside of the frame made the contents visible to themselves only.
        hazard = hazard || ((next.entry.stages & ~before.exit.stages) | (next.entry.access & ~before.exit.access)) != 0;
        if (!transition && (before.exit.stages == 0 || !hazard)) return false;
        placed_.push_back(
            {next.first_group, {resource, waited_for(before.exit), next.entry, before.exit_layout, next.entry_layout}});
        return true;
    }

    /// Sorts the barriers, found resource by resource, into batches.
    void distribute() {
        Plan& plan = compilation_.plan;
        std::stable_sort(placed_.begin(), placed_.end(),
                         [](const Placed& a, const Placed& b) { return a.group < b.group; });
        size_t next = 0;
        for (uint32_t group = 0; group <= plan.groups.size(); ++group) {
            BarrierBatch& batch = group < plan.groups.size() ? plan.groups[group].barriers : plan.final_barriers;
            batch.images.first = static_cast<uint32_t>(plan.image_barriers.size());
            batch.buffers.first = static_cast<uint32_t>(plan.buffer_barriers.size());
            for (; next < placed_.size() && placed_[next].group == group; ++next) {
                const ImageBarrier& barrier = placed_[next].barrier;
                if (compilation_.declaration.resources[barrier.resource].kind == ResourceKind::image) {
                    plan.image_barriers.push_back(barrier);
                    ++batch.images.count;
                } else {
                    plan.buffer_barriers.push_back({barrier.resource, barrier.source, barrier.destination});
                    ++batch.buffers.count;
                }
            }
        }
    }

    Compilation& compilation_;
    std::vector<Scope> last_exit_;  // one a resource: the exit of its last run
    std::vector<Placed> placed_;
};

}  // namespace

void plan_barriers(Compilation& compilation) {
    BarrierPlanner(compilation).run();
}

}  // namespace splice::graph
