// A pass is kept if it has a side effect or writes contents that someone wants: a kept pass, or the world outside.
// One walk backwards through the declaration, which is a valid order.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>

namespace splice::graph {
namespace {

/// What becomes of a resource after the point that the walk has reached.
struct Future {
    bool wanted = false;
    uint32_t overwriter = none;     // the kept pass that replaces the contents unseen
    uint32_t culled_reader = none;  // a culled pass that would have read them
};

CulledPass explain_cull(const Compilation& compilation, const std::vector<Future>& futures, uint32_t pass) {
    CulledPass culled{pass, CullReason::writes_nothing, none, none};
    for (const Access& access : compilation.graph.accesses(pass)) {
        if (!is_write(access.kind)) continue;
        const Future& future = futures[access.resource];
        culled.resource = access.resource;
        if (future.culled_reader != none) {
            culled.reason = CullReason::readers_culled;
            culled.other = future.culled_reader;
        } else if (future.overwriter != none) {
            culled.reason = CullReason::overwritten;
            culled.other = future.overwriter;
        } else {
            culled.reason = CullReason::never_read;
        }
        break;
    }
    return culled;
}

void walk_pass(const Compilation& compilation, uint32_t pass, bool kept, std::vector<Future>& futures) {
    for (const Access& access : compilation.graph.accesses(pass)) {
        Future& future = futures[access.resource];
        const bool reads = !is_write(access.kind) || access.contents == ContentsKind::keep;
        if (kept && reads) {
            future.wanted = true;
        } else if (kept) {
            future = {false, pass, none};
        } else if (reads && !future.wanted) {
            future.culled_reader = pass;
        }
    }
}

/// Culls what leads to nothing `wanted` after the frame. Adds to that the current half of each history whose previous
/// half is read, and says whether it did.
bool walk_backwards(Compilation& compilation, std::vector<uint8_t>& wanted) {
    const Declaration& declaration = compilation.declaration;
    std::vector<CulledPass>& culled = compilation.plan.culled;
    culled.clear();
    std::vector<Future> futures(wanted.size());
    for (size_t resource = 0; resource < futures.size(); ++resource)
        futures[resource].wanted = wanted[resource] != 0;
    bool grew = false;
    for (auto pass = static_cast<uint32_t>(declaration.passes.size()); pass-- > 0;) {
        bool kept = declaration.passes[pass].side_effect;
        for (const Access& access : compilation.graph.accesses(pass)) {
            kept = kept || (is_write(access.kind) && futures[access.resource].wanted);
        }
        compilation.kept[pass] = kept ? 1 : 0;
        if (!kept) culled.push_back(explain_cull(compilation, futures, pass));
        walk_pass(compilation, pass, kept, futures);
        for (const Access& access : compilation.graph.accesses(pass)) {
            if (!kept || declaration.resources[access.resource].history != HistoryRole::previous) continue;
            grew = grew || wanted[access.resource + 1] == 0;
            wanted[access.resource + 1] = 1;
        }
    }
    std::reverse(culled.begin(), culled.end());
    return grew;
}

}  // namespace

void cull(Compilation& compilation) {
    const Declaration& declaration = compilation.declaration;
    compilation.kept.assign(declaration.passes.size(), 1);
    if (!compilation.options.cull) return;
    // What a kept pass reads of the last frame, this frame must make for the next: known after a walk, which makes
    // another one necessary. Each finds a history that the one before did not know to be wanted.
    std::vector<uint8_t> wanted(declaration.resources.size(), 0);
    for (uint32_t resource = 0; resource < wanted.size(); ++resource) {
        if (declaration.resources[resource].imported) wanted[resource] = declaration.import_of(resource).wanted;
    }
    while (walk_backwards(compilation, wanted)) {
    }
}

}  // namespace splice::graph
