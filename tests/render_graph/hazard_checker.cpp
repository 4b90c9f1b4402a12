#include "tests/render_graph/hazard_checker.h"

#include "tests/render_graph/access_model.h"
#include "tests/render_graph/plan_checker.h"

#include <algorithm>
#include <map>

namespace splice::test {
namespace {

using graph::AccessKind;
using graph::none;

struct ResourceState {
    std::vector<Atom> reads, writes;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    uint32_t maker = none;  // the pass that made the contents
    bool has_contents = false;
};

class Walker {
  public:
    Walker(const graph::Graph& graph, const graph::Plan& plan, const std::vector<graph::MemoryRequirement>& memory)
        : graph_(graph),
          plan_(plan),
          sharers_(find_sharers(plan, memory)),
          states_(graph.declaration().resources.size()) {
        find_expected_makers();
    }

    std::vector<std::string> walk() {
        for (const graph::Group& group : plan_.groups) {
            if (group.render_pass == none) continue;
            if (plan_.render_passes[group.render_pass].subpasses.count != group.passes.count)
                return problems_;  // which the plan checker reports
        }
        start_histories();
        // What a history wrote in one frame is read in the next, and overwritten in the one after.
        for (frame_ = 0; frame_ < (histories_.empty() ? 2 : 4); ++frame_) {
            walk_frame();
            for (const uint32_t previous : histories_)
                std::swap(states_[previous], states_[previous + 1]);
        }
        return problems_;
    }

  private:
    void report(uint32_t pass, uint32_t resource, const std::string& problem) {
        const std::string where = pass == none ? "end of frame" : "pass '" + graph_.pass_name(pass) + "'";
        problems_.push_back(where + ", " + graph::quote_resource(graph_, resource) + ": " + problem);
    }

    const graph::ResourceDeclaration& declared(uint32_t resource) const {
        return graph_.declaration().resources[resource];
    }
    bool is_image(uint32_t resource) const { return declared(resource).kind == graph::ResourceKind::image; }

    /// Which pass each access finds the contents of, by the declaration alone.
    void find_expected_makers() {
        const auto& passes = graph_.declaration().passes;
        std::vector<uint32_t> last(states_.size(), none);
        expected_.resize(graph_.declaration().accesses.size(), none);
        for (uint32_t pass = 0; pass < passes.size(); ++pass) {
            for (uint32_t i = 0; i < passes[pass].access_count; ++i) {
                const graph::Access& access = graph_.declaration().accesses[passes[pass].first_access + i];
                expected_[passes[pass].first_access + i] = last[access.resource];
            }
            for (const graph::Access& access : graph_.accesses(pass)) {
                if (writes(steps_of(access))) last[access.resource] = pass;
            }
        }
        final_makers_ = last;
    }

    void walk_frame() {
        for (uint32_t resource = 0; resource < states_.size(); ++resource) {
            if (declared(resource).imported) start_imported(resource);
        }
        for (const graph::Group& group : plan_.groups) {
            const uint32_t first_pass = plan_.order[group.passes.first];
            apply_batch(group.barriers, first_pass);
            if (group.render_pass == none) {
                for (const uint32_t pass : slice(plan_.order, group.passes))
                    use_pass(pass, none);
            } else {
                walk_render_pass(plan_.render_passes[group.render_pass]);
            }
        }
        apply_batch(plan_.final_barriers, none);
        for (uint32_t resource = 0; resource < states_.size(); ++resource) {
            if (declared(resource).imported) finish_imported(resource);
        }
    }

    /// What the executor guarantees at the first frame: contents that everyone sees, in the planned layout.
    void start_histories() {
        for (uint32_t resource = 0; resource < states_.size(); ++resource) {
            if (declared(resource).history != graph::HistoryRole::previous) continue;
            histories_.push_back(resource);
            Atom initial;
            initial.stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
            initial.writes = VK_ACCESS_TRANSFER_WRITE_BIT;
            initial.available = true;
            initial.after = ~0U;
            for (const Step& step : shader_steps(~0U, 0, 0))
                initial.visible[step.stage] = ~0U;
            states_[resource].writes.push_back(initial);
            states_[resource].layout = plan_.resources[resource].initial_layout;
            states_[resource].has_contents = true;
        }
    }

    /// The pass whose contents the access must find.
    uint32_t expected_maker(uint32_t index) const {
        const uint32_t resource = graph_.declaration().accesses[index].resource;
        if (declared(resource).history != graph::HistoryRole::previous) return expected_[index];
        return frame_ == 0 ? none : final_makers_[resource + 1];
    }

    void start_imported(uint32_t resource) {
        ResourceState& state = states_[resource];
        const graph::ExternalUse& before = graph_.declaration().import_of(resource).before;
        state = {};
        state.layout = before.layout;
        state.has_contents = !is_image(resource) || before.layout != VK_IMAGE_LAYOUT_UNDEFINED;
        for (const Step& step : shader_steps(before.scope.stages, before.scope.access, 0)) {
            Atom atom;
            atom.stage = step.stage;
            atom.writes = before.scope.access & (VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                                 VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
            (atom.writes != 0 ? state.writes : state.reads).push_back(atom);
        }
        if (before.scope.stages == 0 || !state.writes.empty()) return;
        // Readers before the frame: what they read was made visible to them, to nobody else.
        Atom seen;
        seen.writes = VK_ACCESS_MEMORY_WRITE_BIT;
        seen.available = true;
        seen.after = before.scope.stages;
        for (const Step& step : shader_steps(before.scope.stages, 0, 0))
            seen.visible[step.stage] = before.scope.access;
        state.writes.push_back(seen);
    }

    void finish_imported(uint32_t resource) {
        const graph::ImportOptions& import = graph_.declaration().import_of(resource);
        const ResourceState& state = states_[resource];
        if (is_image(resource) && import.after.layout != VK_IMAGE_LAYOUT_UNDEFINED &&
            state.layout != import.after.layout) {
            report(none, resource, "is not left in the layout asked for");
        }
        if (import.after.scope.stages != 0) {
            check_steps(none, resource, shader_steps(import.after.scope.stages, import.after.scope.access, 0), none);
        }
        if (import.wanted && final_makers_[resource] != none &&
            (!state.has_contents || state.maker != final_makers_[resource])) {
            report(none, resource, "does not hold what the last pass wrote");
        }
    }

    // Barriers
    // ---------------------------------------------------------------------------------------------------------

    /// Stages wait as a whole, so the barrier orders what was done to resources in the same bytes too.
    void apply_barrier(uint32_t resource, const graph::Scope& source, const graph::Scope& destination) {
        const auto extend = [&](ResourceState& state) {
            for (Atom& atom : state.reads)
                atom.extend(source, destination);
            for (Atom& atom : state.writes)
                atom.extend(source, destination);
        };
        extend(states_[resource]);
        for (const uint32_t other : sharers_[resource])
            extend(states_[other]);
    }

    /// The resource begins anew in its memory: whoever else used these bytes must be done, and loses its contents.
    void take_memory(uint32_t pass, uint32_t resource, const graph::Scope& source) {
        for (const uint32_t other : sharers_[resource]) {
            ResourceState& state = states_[other];
            for (const Atom& atom : state.reads) {
                if (!atom.ordered_before(source.stages)) report(pass, resource, "takes memory that is still read");
            }
            for (const Atom& atom : state.writes) {
                const bool flushed =
                    atom.available || ((atom.stage & source.stages) != 0 && (atom.writes & ~source.access) == 0);
                if (!atom.ordered_before(source.stages) || !flushed) {
                    report(pass, resource, "takes memory that is still written");
                }
            }
            state.has_contents = false;
            state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        }
    }

    bool begins_anew(const graph::Plan& plan, uint32_t resource, const graph::BarrierBatch& batch) const {
        const uint32_t first = plan.resources[resource].lifetime.first_group;
        return first != none && &plan.groups[first].barriers == &batch;
    }

    void apply_batch(const graph::BarrierBatch& batch, uint32_t pass) {
        for (const graph::BufferBarrier& barrier : slice(plan_.buffer_barriers, batch.buffers)) {
            if (begins_anew(plan_, barrier.resource, batch)) take_memory(pass, barrier.resource, barrier.source);
            apply_barrier(barrier.resource, barrier.source, barrier.destination);
        }
        for (const graph::ImageBarrier& barrier : slice(plan_.image_barriers, batch.images)) {
            const uint32_t resource = barrier.resource;
            if (begins_anew(plan_, resource, batch)) take_memory(pass, resource, barrier.source);
            ResourceState& state = states_[resource];
            apply_barrier(resource, barrier.source, barrier.destination);
            if (barrier.old_layout == barrier.new_layout) continue;
            if (barrier.old_layout != VK_IMAGE_LAYOUT_UNDEFINED && barrier.old_layout != state.layout) {
                report(pass, resource, "a barrier expects a layout that the image is not in");
            }
            for (const Atom& atom : state.reads) {
                if (!atom.ordered_before(barrier.source.stages)) report(pass, resource, "transition while read");
            }
            for (const Atom& atom : state.writes) {
                if (!atom.ordered_before(barrier.source.stages) || !atom.available) {
                    report(pass, resource, "transition of contents that are still written");
                }
            }
            if (barrier.old_layout == VK_IMAGE_LAYOUT_UNDEFINED) state.has_contents = false;
            state.layout = barrier.new_layout;
            Atom transition;
            transition.writes = VK_ACCESS_MEMORY_WRITE_BIT;
            transition.available = true;
            transition.after = barrier.destination.stages;
            for (const Step& step : shader_steps(barrier.destination.stages, 0, 0)) {
                transition.visible[step.stage] = barrier.destination.access;
            }
            state.reads.clear();
            state.writes = {transition};
        }
    }

    // Uses
    // -------------------------------------------------------------------------------------------------------------

    void check_steps(uint32_t pass, uint32_t resource, const std::vector<Step>& steps, uint32_t subpass) {
        const ResourceState& state = states_[resource];
        for (const Step& step : steps) {
            for (const Atom& atom : state.writes) {
                if (!atom.ordered(step.stage, subpass)) {
                    report(pass, resource, "is used while it is still written");
                } else if (!atom.seen_by(step, subpass)) {
                    report(pass, resource, "is used before what was written is visible");
                }
            }
            check_sharers(pass, resource, step, subpass);
            if (step.writes == 0) continue;
            for (const Atom& atom : state.reads) {
                if (!atom.ordered(step.stage, subpass)) report(pass, resource, "is written while it is still read");
            }
        }
    }

    /// Nothing that was done to others in these bytes may still be under way.
    void check_sharers(uint32_t pass, uint32_t resource, const Step& step, uint32_t subpass) {
        for (const uint32_t other : sharers_[resource]) {
            for (const std::vector<Atom>* atoms : {&states_[other].reads, &states_[other].writes}) {
                for (const Atom& atom : *atoms) {
                    if (!atom.ordered(step.stage, subpass) || (atom.writes != 0 && !atom.available)) {
                        report(pass, resource,
                               "is used while " + graph::quote_resource(graph_, other) +
                                   " is still used in the same bytes");
                    }
                }
            }
        }
    }

    /// After a write nobody else has contents in these bytes.
    void wipe_sharers(uint32_t resource) {
        for (const uint32_t other : sharers_[resource]) {
            states_[other].has_contents = false;
            states_[other].layout = VK_IMAGE_LAYOUT_UNDEFINED;
        }
    }

    void apply_steps(uint32_t resource, const std::vector<Step>& steps, uint32_t subpass) {
        ResourceState& state = states_[resource];
        if (writes(steps)) {
            state.writes.clear();
            state.reads.clear();
            wipe_sharers(resource);
        }
        for (const Step& step : steps) {
            Atom atom;
            atom.stage = step.stage;
            atom.writes = step.writes;
            atom.subpass = subpass;
            (step.writes != 0 ? state.writes : state.reads).push_back(atom);
        }
    }

    /// All uses of one pass; none of them is ordered against another of the same pass.
    void use_pass(uint32_t pass, uint32_t subpass) {
        const graph::PassDeclaration& declaration = graph_.declaration().passes[pass];
        for (uint32_t i = 0; i < declaration.access_count; ++i) {
            const uint32_t index = declaration.first_access + i;
            const graph::Access& access = graph_.declaration().accesses[index];
            const std::vector<Step> steps = steps_of(access);
            ResourceState& state = states_[access.resource];
            if (is_image(access.resource) &&
                !layout_fits(state.layout, access.kind, declared(access.resource).image.format)) {
                report(pass, access.resource, "is in a layout that does not fit its use");
            }
            check_steps(pass, access.resource, steps, subpass);
            const bool needs = !writes(steps) || access.contents == graph::ContentsKind::keep;
            if (needs && (!state.has_contents || state.maker != expected_maker(index))) {
                report(pass, access.resource, "does not hold the contents that the pass needs");
            }
        }
        for (const graph::Access& access : graph_.accesses(pass)) {
            const std::vector<Step> steps = steps_of(access);
            apply_steps(access.resource, steps, subpass);
            if (writes(steps)) {
                states_[access.resource].maker = pass;
                states_[access.resource].has_contents = true;
            }
        }
    }

    // Render passes
    // ----------------------------------------------------------------------------------------------------

    struct AttachmentUse {
        uint32_t first = none, last = none;  // subpasses
        std::map<uint32_t, VkImageLayout> layouts;
    };

    std::vector<AttachmentUse> attachment_uses(const graph::RenderPass& render_pass) const {
        std::vector<AttachmentUse> uses(render_pass.attachments.count);
        const auto subpasses = slice(plan_.subpasses, render_pass.subpasses);
        for (uint32_t subpass = 0; subpass < subpasses.size(); ++subpass) {
            const graph::Subpass& planned = subpasses[subpass];
            for (const graph::Range range : {planned.colours, planned.inputs, planned.depth_stencil}) {
                for (const graph::AttachmentReference& reference : slice(plan_.references, range)) {
                    AttachmentUse& use = uses[reference.attachment];
                    use.first = std::min(use.first, subpass);
                    use.last = subpass;
                    use.layouts[subpass] = reference.layout;
                }
            }
        }
        return uses;
    }

    void walk_render_pass(const graph::RenderPass& render_pass) {
        const std::vector<AttachmentUse> uses = attachment_uses(render_pass);
        const auto attachments = slice(plan_.attachments, render_pass.attachments);
        const auto subpasses = slice(plan_.subpasses, render_pass.subpasses);
        for (uint32_t i = 0; i < attachments.size(); ++i) {
            const uint32_t resource = attachments[i].resource;
            if (attachments[i].initial_layout != states_[resource].layout) {
                report(subpasses[0].pass, resource, "enters the render pass in another layout than planned");
            }
        }
        for (uint32_t subpass = 0; subpass < subpasses.size(); ++subpass) {
            for (const graph::SubpassDependency& dependency : slice(plan_.dependencies, render_pass.dependencies)) {
                if (dependency.destination == subpass) each_atom([&](Atom& atom) { atom.extend(dependency); });
            }
            for (uint32_t i = 0; i < attachments.size(); ++i) {
                if (uses[i].layouts.count(subpass) != 0) enter_subpass(attachments[i], uses[i], subpass, subpasses);
            }
            use_pass(subpasses[subpass].pass, subpass);
            check_preserved(render_pass, uses, subpass);
            for (uint32_t i = 0; i < attachments.size(); ++i) {
                if (uses[i].last == subpass) store(attachments[i], subpasses[subpass].pass, subpass);
            }
        }
        each_atom([](Atom& atom) { atom.leave_render_pass(); });
        for (const graph::Attachment& attachment : attachments) {
            if (states_[attachment.resource].layout != attachment.final_layout) {
                report(subpasses.back().pass, attachment.resource, "leaves the render pass in another layout");
            }
        }
    }

    template <typename Function>
    void each_atom(const Function& function) {
        for (ResourceState& state : states_) {
            std::for_each(state.reads.begin(), state.reads.end(), function);
            std::for_each(state.writes.begin(), state.writes.end(), function);
        }
    }

    void enter_subpass(const graph::Attachment& attachment, const AttachmentUse& use, uint32_t subpass,
                       std::span<const graph::Subpass> subpasses) {
        const uint32_t resource = attachment.resource, pass = subpasses[subpass].pass;
        ResourceState& state = states_[resource];
        const VkFormat format = declared(resource).image.format;
        if (use.first == subpass) {
            const Step load = load_step(format, attachment.load);
            check_steps(pass, resource, {load}, subpass);
            if (attachment.load != VK_ATTACHMENT_LOAD_OP_LOAD) {
                // Loading comes before every use in the subpass, without a dependency.
                apply_steps(resource, {load}, subpass);
                Atom& atom = state.writes.back();
                atom.available = true;
                for (const Step& step :
                     {Step{kColour, 0, 0}, Step{kEarly, 0, 0}, Step{kLate, 0, 0}, Step{kFragment, 0, 0}}) {
                    atom.after_in[subpass] |= step.stage;
                    atom.visible_in[subpass][step.stage] = ~0U;
                }
                state.has_contents = false;
            }
        }
        const VkImageLayout layout = use.layouts.at(subpass);
        if (layout == state.layout) return;
        // The transition between subpasses is ordered by the dependencies of the attachment's uses.
        for (const std::vector<Atom>* atoms : {&state.reads, &state.writes}) {
            for (const Atom& atom : *atoms) {
                const bool before = atom.subpass == none || atom.after_in.count(subpass) != 0;
                if (!before || (atom.writes != 0 && !atom.available)) {
                    report(pass, resource, "changes layout between subpasses without a dependency");
                }
            }
        }
        state.layout = layout;
    }

    void check_preserved(const graph::RenderPass& render_pass, const std::vector<AttachmentUse>& uses,
                         uint32_t subpass) {
        const graph::Subpass& planned = slice(plan_.subpasses, render_pass.subpasses)[subpass];
        const auto preserved = slice(plan_.preserved, planned.preserved);
        for (uint32_t i = 0; i < uses.size(); ++i) {
            const bool needed =
                uses[i].first < subpass && subpass < uses[i].last && uses[i].layouts.count(subpass) == 0;
            const bool named = std::find(preserved.begin(), preserved.end(), i) != preserved.end();
            if (needed != named) {
                report(planned.pass, slice(plan_.attachments, render_pass.attachments)[i].resource,
                       needed ? "is not preserved" : "is preserved for nobody");
            }
        }
    }

    /// Storing comes after every use in the last subpass; uses in subpasses before must be ordered by dependencies.
    void store(const graph::Attachment& attachment, uint32_t pass, uint32_t subpass) {
        const uint32_t resource = attachment.resource;
        ResourceState& state = states_[resource];
        if (attachment.store == VK_ATTACHMENT_STORE_OP_NONE) {
            // What a render pass wrote and does not store is lost.
            const auto here = [](const Atom& atom) { return atom.subpass != none; };
            if (std::any_of(state.writes.begin(), state.writes.end(), here)) state.has_contents = false;
            return;
        }
        for (const Atom& atom : state.reads) {
            if (atom.subpass != subpass && atom.after == 0 && atom.after_in.count(subpass) == 0) {
                report(pass, resource, "is stored while an earlier subpass still reads it");
            }
        }
        const bool depth = has_depth(declared(resource).image.format);
        apply_steps(resource,
                    {{depth ? kLate : kColour, 0,
                      depth ? VkAccessFlags{VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT}
                            : VkAccessFlags{VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT}}},
                    subpass);
        if (attachment.store == VK_ATTACHMENT_STORE_OP_DONT_CARE) state.has_contents = false;
    }

    const graph::Graph& graph_;
    const graph::Plan& plan_;
    std::vector<std::vector<uint32_t>> sharers_;  // one a resource: who has bytes in common with it
    std::vector<ResourceState> states_;
    std::vector<uint32_t> expected_;      // one an access: the pass whose contents it finds
    std::vector<uint32_t> final_makers_;  // one a resource: the last pass that writes it
    std::vector<uint32_t> histories_;     // previous halves
    int frame_ = 0;
    std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> find_hazards(const graph::Graph& graph, const graph::Plan& plan,
                                      const std::vector<graph::MemoryRequirement>& memory) {
    std::vector<std::string> problems = find_flaws(graph, plan, memory);
    std::vector<std::string> hazards = find_disorder(graph, plan);
    if (hazards.empty()) hazards = Walker(graph, plan, memory).walk();  // which follows the order
    problems.insert(problems.end(), hazards.begin(), hazards.end());
    return problems;
}

}  // namespace splice::test
