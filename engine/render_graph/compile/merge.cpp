// Groups graphics passes that hand pixels to each other only as attachments, so that they become the subpasses of one
// render pass. Decided on the dependencies, before any order exists: a pass joins the group of the last pass that used
// one of its attachments, if nothing outside of the group must run between them. Ordering the groups then keeps each
// together.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>

namespace splice::graph {
namespace {

// The search for a path around a group gives up after this many edges and does not merge: keeps compilation linear.
constexpr uint32_t kSearchBudget = 512;

struct MergeGroup {
    uint32_t first = none, last = none;  // passes, linked by Merger::next_
    /// Higher than that of every group it depends on: the search for a path stops where the rank says there is none.
    uint32_t rank = 0;
    uint32_t search = 0;     // the last search that came here
    uint32_t candidate = 0;  // where it was last among Merger::candidates_
};

/// How the group that is looked at uses a resource.
struct Use {
    uint32_t group = none;  // the group that this entry speaks of
    bool attachment = false, other = false, writes = false;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // of other uses
};

class Merger {
  public:
    explicit Merger(Compilation& compilation)
        : compilation_(compilation),
          uses_(compilation.declaration.resources.size()),
          last_attachment_user_(compilation.declaration.resources.size(), none),
          next_(compilation.declaration.passes.size(), none) {
        groups_.reserve(compilation.declaration.passes.size());
    }

    void run() {
        const Declaration& declaration = compilation_.declaration;
        compilation_.group_of.assign(declaration.passes.size(), none);
        for (uint32_t pass = 0; pass < declaration.passes.size(); ++pass) {
            if (!compilation_.kept[pass]) continue;
            const bool graphics = declaration.passes[pass].kind == PassKind::graphics;
            if (!graphics || !join_a_group(pass)) {
                compilation_.group_of[pass] = static_cast<uint32_t>(groups_.size());
                groups_.push_back({pass, pass, rank_after(pass, none, 0), 0, 0});
            }
            if (!graphics) continue;
            for (const Access& access : compilation_.graph.accesses(pass)) {
                if (is_attachment(access.kind)) last_attachment_user_[access.resource] = pass;
            }
        }
    }

  private:
    void find_successors() {
        const std::pmr::vector<Range>& predecessors = compilation_.predecessors;
        successors_of_.assign(predecessors.size() + 1, 0);
        for (const Edge& edge : compilation_.edges)
            ++successors_of_[edge.from + 1];
        for (size_t pass = 0; pass < predecessors.size(); ++pass)
            successors_of_[pass + 1] += successors_of_[pass];
        std::vector<uint32_t> next(successors_of_.begin(), successors_of_.end() - 1);
        successors_.resize(compilation_.edges.size());
        for (uint32_t pass = 0; pass < predecessors.size(); ++pass) {
            for (const Edge& edge : compilation_.predecessors_of(pass))
                successors_[next[edge.from]++] = pass;
        }
    }

    /// At least `rank`, and higher than that of the groups that the pass depends on, its own aside.
    uint32_t rank_after(uint32_t pass, uint32_t group, uint32_t rank) const {
        for (const Edge& edge : compilation_.predecessors_of(pass)) {
            const uint32_t other = compilation_.group_of[edge.from];
            if (other != group) rank = std::max(rank, groups_[other].rank + 1);
        }
        return rank;
    }

    /// After `pass` has joined the group: restores the order of ranks there and in all that depends on the group.
    void raise_rank(uint32_t group, uint32_t pass) {
        const uint32_t rank = rank_after(pass, group, groups_[group].rank);
        if (rank == groups_[group].rank) return;
        if (successors_of_.empty()) find_successors();
        groups_[group].rank = rank;
        stack_.assign(1, group);
        while (!stack_.empty()) {
            const uint32_t node = stack_.back();
            stack_.pop_back();
            for (uint32_t member = groups_[node].first; member != none; member = next_[member]) {
                for (uint32_t i = successors_of_[member]; i < successors_of_[member + 1]; ++i) {
                    const uint32_t other = compilation_.group_of[successors_[i]];
                    if (other == none || other == node || groups_[other].rank > groups_[node].rank) continue;
                    groups_[other].rank = groups_[node].rank + 1;
                    stack_.push_back(other);
                }
            }
        }
    }

    /// A pass whose group another might join.
    struct Candidate {
        uint32_t pass, group;
        uint32_t handed_over;  // a resource that the two do not hand over as an attachment; none if all are
    };

    /// Those that share an attachment with the pass, or hand over something else. Latest group first, one a group.
    void find_candidates(uint32_t pass) {
        candidates_.clear();
        const auto add = [&](uint32_t earlier, uint32_t handed_over) {
            const uint32_t group = compilation_.group_of[earlier];
            if (groups_[group].candidate < candidates_.size() && candidates_[groups_[group].candidate].group == group) {
                Candidate& known = candidates_[groups_[group].candidate];
                // The latest pass, but rather one that tells why not.
                const bool better =
                    (handed_over != none) != (known.handed_over != none) ? handed_over != none : earlier > known.pass;
                if (better) known = {earlier, group, handed_over};
                return;
            }
            groups_[group].candidate = static_cast<uint32_t>(candidates_.size());
            candidates_.push_back({earlier, group, handed_over});
        };
        for (const Access& access : compilation_.graph.accesses(pass)) {
            if (is_attachment(access.kind) && last_attachment_user_[access.resource] != none) {
                add(last_attachment_user_[access.resource], none);
            }
        }
        for (const Edge& edge : compilation_.predecessors_of(pass)) {
            if (edge.resource == none) continue;
            if (compilation_.declaration.passes[edge.from].kind != PassKind::graphics) continue;
            add(edge.from, edge.as_attachment ? none : edge.resource);
        }
        std::sort(candidates_.begin(), candidates_.end(), [&](const Candidate& a, const Candidate& b) {
            return groups_[a.group].last > groups_[b.group].last;
        });
    }

    bool join_a_group(uint32_t pass) {
        find_candidates(pass);
        for (const Candidate& candidate : candidates_) {
            const uint32_t group = candidate.group;
            Unmerged unmerged{candidate.pass, pass, UnmergedReason::switched_off, none, none};
            if (compilation_.options.merge && candidate.handed_over != none) {
                unmerged.reason = UnmergedReason::not_pixel_local;
                unmerged.resource = candidate.handed_over;
            } else if (compilation_.options.merge && can_join(group, pass, unmerged)) {
                compilation_.group_of[pass] = group;
                groups_[group].last = next_[groups_[group].last] = pass;
                if (loaded_ == group) load_pass(pass);
                raise_rank(group, pass);
                return true;
            }
            compilation_.plan.unmerged.push_back(unmerged);
        }
        return false;
    }

    bool can_join(uint32_t group, uint32_t pass, Unmerged& unmerged) {
        load_group(group);
        return pixel_local(pass, unmerged) && same_area(group, pass, unmerged) &&
               nothing_between(group, pass, unmerged);
    }

    void load_group(uint32_t group) {
        if (loaded_ == group) return;
        loaded_ = group;
        ++generation_;
        for (uint32_t pass = groups_[group].first; pass != none; pass = next_[pass])
            load_pass(pass);
    }

    void load_pass(uint32_t pass) {
        for (const Access& access : compilation_.graph.accesses(pass)) {
            Use& use = uses_[access.resource];
            if (use.group != generation_) use = {generation_, false, false, false, VK_IMAGE_LAYOUT_UNDEFINED};
            use.writes = use.writes || is_write(access.kind);
            if (is_attachment(access.kind)) {
                use.attachment = true;
            } else {
                use.other = true;
                use.layout = layout(access);
            }
        }
    }

    VkImageLayout layout(const Access& access) const {
        return layout_of(access.kind, compilation_.declaration.resources[access.resource].image.format);
    }

    bool pixel_local(uint32_t pass, Unmerged& unmerged) const {
        for (const Access& access : compilation_.graph.accesses(pass)) {
            const Use& use = uses_[access.resource];
            if (use.group != generation_) continue;
            unmerged.resource = access.resource;
            if (is_attachment(access.kind) && !use.other) {
                // A render pass clears an attachment only as it begins.
                unmerged.reason = UnmergedReason::clears_attachment;
                if (access.contents == ContentsKind::clear) return false;
                continue;
            }
            unmerged.reason = UnmergedReason::not_pixel_local;
            if (is_attachment(access.kind) || use.attachment || use.writes || is_write(access.kind)) return false;
            unmerged.reason = UnmergedReason::different_layouts;
            if (use.layout != layout(access)) return false;
        }
        return true;
    }

    /// The image that sets size and samples: a target if there is one, since inputs may have other samples.
    const ImageDescription& area(uint32_t pass) const {
        const ImageDescription* image = nullptr;
        for (const Access& access : compilation_.graph.accesses(pass)) {
            if (!is_attachment(access.kind)) continue;
            image = &compilation_.declaration.resources[access.resource].image;
            if (access.kind != AccessKind::input_attachment) break;
        }
        return *image;  // validate() saw that every graphics pass has an attachment
    }

    bool same_area(uint32_t group, uint32_t pass, Unmerged& unmerged) const {
        const ImageDescription& a = area(groups_[group].first);
        const ImageDescription& b = area(pass);
        unmerged.resource = none;
        unmerged.reason = UnmergedReason::different_size;
        if (a.width != b.width || a.height != b.height || a.layers != b.layers) return false;
        unmerged.reason = UnmergedReason::different_samples;
        return a.samples == b.samples;
    }

    /// No path leads out of the group and back to the pass: searched backwards from its predecessors, group by group.
    bool nothing_between(uint32_t group, uint32_t pass, Unmerged& unmerged) {
        ++search_;
        stack_.clear();
        uint32_t budget = kSearchBudget;
        unmerged.reason = UnmergedReason::pass_between;
        const auto push = [&](uint32_t from) {
            const uint32_t other = compilation_.group_of[from];
            if (other == group || groups_[other].search == search_) return;
            groups_[other].search = search_;
            if (groups_[other].rank > groups_[group].rank) stack_.push_back(other);
        };
        for (const Edge& edge : compilation_.predecessors_of(pass)) {
            unmerged.other = edge.from;
            push(edge.from);
            while (!stack_.empty()) {
                const uint32_t node = stack_.back();
                stack_.pop_back();
                for (uint32_t member = groups_[node].first; member != none; member = next_[member]) {
                    for (const Edge& back : compilation_.predecessors_of(member)) {
                        if (compilation_.group_of[back.from] == group) return false;
                        if (budget-- == 0) {
                            unmerged.reason = UnmergedReason::gave_up;
                            return false;
                        }
                        push(back.from);
                    }
                }
            }
        }
        return true;
    }

    Compilation& compilation_;
    std::vector<MergeGroup> groups_;
    std::vector<Use> uses_;  // one a resource
    std::vector<uint32_t> last_attachment_user_;
    std::vector<uint32_t> next_;  // one a pass: the next of its group
    std::vector<Candidate> candidates_;
    uint32_t loaded_ = none, generation_ = 0;
    std::vector<uint32_t> successors_, successors_of_;  // passes; where those of a pass begin
    uint32_t search_ = 0;
    std::vector<uint32_t> stack_;  // groups
};

}  // namespace

void merge(Compilation& compilation) {
    Merger(compilation).run();
}

}  // namespace splice::graph
