// Barriers between groups. The uses of a resource fall into runs - one writing group, or consecutive groups that only
// read it in one layout - and one barrier before each run waits for the run before. All barriers before a group are one
// batch.
#include "engine/render_graph/compile/compilation.h"

#include <utility>

namespace splice::graph {
namespace {

struct Run {
    uint32_t first_group = none;
    Scope entry, exit;
    VkImageLayout entry_layout = VK_IMAGE_LAYOUT_UNDEFINED, exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool writes = false, needs_contents = true;
};

/// How many of the uses, from the first, belong to one run.
size_t run_length(std::span<const GroupUse> uses, bool batch) {
    size_t length = 1;
    if (uses[0].writes || !batch) return length;
    while (length < uses.size() && !uses[length].writes && uses[length].entry_layout == uses[0].exit_layout)
        ++length;
    return length;
}

/// Takes the first run off the uses.
Run take_run(std::span<const GroupUse>& uses, bool batch) {
    const size_t length = run_length(uses, batch);
    Run run{uses[0].group,       uses[0].entry,  uses[0].exit,          uses[0].entry_layout,
            uses[0].exit_layout, uses[0].writes, uses[0].needs_contents};
    for (const GroupUse& use : uses.subspan(1, length - 1)) {
        run.entry |= use.entry;
        run.exit |= use.exit;
    }
    uses = uses.subspan(length);
    return run;
}

/// The exit of the last run, which later users of the memory wait for.
Scope last_exit(std::span<const GroupUse> uses) {
    Scope exit;
    for (size_t i = uses.size(); i-- > 0;) {
        if (i + 1 < uses.size() && (uses[i].writes || uses[i].exit_layout != uses[i + 1].entry_layout)) break;
        exit |= uses[i].exit;
        if (uses[i].writes) break;
    }
    return exit;
}

Scope waited_for(const Scope& scope) {
    return {scope.stages, write_access(scope.access)};
}

class BarrierPlanner {
  public:
    explicit BarrierPlanner(Compilation& compilation) : compilation_(compilation) {}

    void run() {
        const auto resources = static_cast<uint32_t>(compilation_.declaration.resources.size());
        compilation_.plan.batch_barriers = compilation_.options.batch_barriers;
        find_last_exits();
        placed_.reserve(compilation_.uses.size());
        for (uint32_t resource = 0; resource < resources; ++resource)
            plan_resource(resource);
        distribute();
    }

  private:
    struct Placed {
        uint32_t group;
        ImageBarrier barrier;
    };

    void find_last_exits() {
        last_exit_.reserve(compilation_.declaration.resources.size());
        for (uint32_t resource = 0; resource < compilation_.declaration.resources.size(); ++resource)
            last_exit_.push_back(last_exit(compilation_.uses_of_resource(resource)));
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

    /// What comes before the first use in the frame.
    Run before_frame(uint32_t resource) const {
        const ResourceDeclaration& declared = compilation_.declaration.resources[resource];
        Run before;
        before.writes = true;
        if (declared.imported) {
            const ExternalUse& outside = compilation_.declaration.import_of(resource).before;
            before.exit = outside.scope;
            if (declared.kind == ResourceKind::image) before.exit_layout = outside.layout;
            before.writes = write_access(before.exit.access) != 0;
        } else if (declared.history == HistoryRole::previous) {
            // The other half, as the frame before left it.
            const std::span<const GroupUse> uses = compilation_.uses_of_resource(resource + 1);
            before.exit = last_exit_[resource + 1];
            before.exit_layout = uses.back().exit_layout;
            // Readers with a barrier each saw the contents each with its own stages and accesses: what all of them have
            // together was made visible to none.
            before.writes = uses.back().writes || !compilation_.options.batch_barriers;
        } else if (declared.history == HistoryRole::current) {
            // The frame before last wrote what the last one then may have read, or not.
            before.exit = waited_for(last_exit_[resource - 1]);
            before.exit |= waited_for(last_exit_[resource]);
        } else {
            before.exit = previous_occupants(resource);
        }
        return before;
    }

    void plan_resource(uint32_t resource) {
        const ResourceDeclaration& declared = compilation_.declaration.resources[resource];
        std::span<const GroupUse> uses = compilation_.uses_of_resource(resource);
        if (uses.empty() && !declared.imported) return;
        Run before = before_frame(resource);
        if (declared.history == HistoryRole::previous) {
            compilation_.plan.resources[resource].initial_layout = before.exit_layout;
        }
        const bool batch = compilation_.options.batch_barriers;
        const Run after = declared.imported ? outside(resource, before, uses) : Run{};
        while (!uses.empty()) {
            Run next = take_run(uses, batch);
            if (!next.needs_contents) before.exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
            const bool joins =
                batch && uses.empty() && !next.writes && !after.writes && next.exit_layout == after.entry_layout;
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
        const ExternalUse& after = compilation_.declaration.import_of(resource).after;
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
        const auto batch_of = [&](const Placed& placed) -> BarrierBatch& {
            return placed.group < plan.groups.size() ? plan.groups[placed.group].barriers : plan.final_barriers;
        };
        const auto is_image = [&](const Placed& placed) {
            return compilation_.declaration.resources[placed.barrier.resource].kind == ResourceKind::image;
        };
        for (const Placed& placed : placed_) {
            BarrierBatch& batch = batch_of(placed);
            ++(is_image(placed) ? batch.images : batch.buffers).count;
        }
        uint32_t images = 0, buffers = 0;
        const auto start = [&](BarrierBatch& batch) {
            batch.images.first = images;
            batch.buffers.first = buffers;
            images += std::exchange(batch.images.count, 0);
            buffers += std::exchange(batch.buffers.count, 0);
        };
        for (Group& group : plan.groups)
            start(group.barriers);
        start(plan.final_barriers);
        plan.image_barriers.resize(images);
        plan.buffer_barriers.resize(buffers);
        for (const Placed& placed : placed_) {
            BarrierBatch& batch = batch_of(placed);
            const ImageBarrier& barrier = placed.barrier;
            if (is_image(placed)) {
                plan.image_barriers[batch.images.first + batch.images.count++] = barrier;
            } else {
                plan.buffer_barriers[batch.buffers.first + batch.buffers.count++] = {barrier.resource, barrier.source,
                                                                                     barrier.destination};
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
