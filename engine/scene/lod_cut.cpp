// Pajarola et al. 2004, section 6.2: a walk down the tree, siblings at a time (sibling_verdicts.h).
#include "engine/scene/lod_cut.h"

#include "engine/scene/sibling_verdicts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

namespace splice {

namespace {

// Subtrees that are walked at once.
constexpr std::size_t kTasks = 64;
constexpr int kMostRounds = 8;
// Nodes side by side that the walk has reached.
struct Siblings {
    std::uint32_t first = 0, count = 0;
    std::uint32_t level = 0;
    bool inside = false;  // their disks are wholly in the frustum
    bool chosen = false;  // of a patch of which surfels are to be drawn
};

// What becomes of siblings, a bit each.
struct Fates {
    std::uint32_t pending = 0;                             // not yet dealt with
    std::uint32_t ellipses = 0, surfels = 0, choices = 0;  // the others are descended into
    std::uint32_t inside = 0;                              // as SiblingVerdicts
    std::uint32_t fits = 0;                                // CutRun::fits_point
};

// What all of a walk share.
class Rules {
  public:
    Rules(const PointHierarchy& hierarchy, const CutView& view)
        : hierarchy_(hierarchy), view_(view), judge_(hierarchy, view) {}

    const PointHierarchy& hierarchy() const { return hierarchy_; }

    Fates decide(const Siblings& siblings, CutStatistics& statistics) const {
        const std::uint32_t all = (1u << siblings.count) - 1;
        const SiblingVerdicts verdicts = judge_.judge(siblings.first, siblings.count);
        statistics.visited += siblings.count;
        Fates fates;
        fates.pending = all;
        std::uint32_t in_part = 0;
        if (!view_.left_out.empty()) leave_out(siblings.first, fates.pending, in_part);
        fates.inside = verdicts.inside();
        if (siblings.inside) {
            fates.inside = all;
        } else {
            statistics.outside_frustum += ones(fates.pending & verdicts.outside());
            fates.pending &= ~verdicts.outside();
        }
        statistics.facing_away += ones(fates.pending & verdicts.away());
        fates.pending &= ~verdicts.away();
        fates.ellipses = verdicts.small() & fates.pending & ~in_part;
        const std::uint64_t kinds = kinds_of(siblings.first);
        const std::uint32_t others = fates.pending & ~fates.ellipses & ~in_part;
        if (!siblings.chosen && !view_.triangle_costs.empty()) fates.choices = others & which(kinds, kPatchNode);
        // Where nothing below is small enough from anywhere, either, there is nothing left to decide; but for nodes
        // that face away, if they are worth looking for.
        const std::uint32_t full =
            verdicts.never() & verdicts.fine() & fates.inside & (view_.two_sided ? all : which(kinds, kSmallNode));
        fates.surfels = others & ~fates.choices & (full | which(kinds, kLeafNode));
        fates.fits = fates.inside & ((fates.ellipses & verdicts.narrow()) | (fates.surfels & verdicts.fine()));
        return fates;
    }

    Siblings children_of(const Siblings& siblings, const Fates& fates, std::uint32_t i) const {
        const std::uint32_t node = siblings.first + i;
        return {hierarchy_.first_child[node], hierarchy_.child_counts[node], siblings.level + 1,
                (fates.inside >> i & 1) != 0, siblings.chosen};
    }

    std::uint32_t patch_of(std::uint32_t node) const {
        return std::lower_bound(hierarchy_.patches.begin(), hierarchy_.patches.end(), std::pair{node, 0U})->second;
    }
    double triangle_cost(std::uint32_t patch) const { return view_.triangle_costs[patch]; }

    std::uint32_t first_surfel(std::uint32_t node) const { return hierarchy_.first_surfel[node]; }
    std::uint32_t end_surfel(std::uint32_t node) const {
        return hierarchy_.first_surfel[node] + hierarchy_.surfel_counts[node];
    }

  private:
    static std::uint64_t ones(std::uint32_t bits) {
        return bits == 0 ? 0 : static_cast<std::uint64_t>(std::popcount(bits));
    }

    // A byte a sibling, the first's the lowest.
    std::uint64_t kinds_of(std::uint32_t first) const {
        std::uint64_t kinds;
        std::memcpy(&kinds, hierarchy_.kinds.data() + first, sizeof(kinds));
        return kinds;
    }
    // Of the siblings that are of a kind. The product moves the lowest bit of byte i to bit 56 + i.
    static std::uint32_t which(std::uint64_t kinds, NodeKind kind) {
        const std::uint64_t ones = kinds / kind & 0x0101010101010101;
        return static_cast<std::uint32_t>(ones * 0x0102040810204080 >> 56);
    }

    // CutView::left_out holds all of a node's surfels, or some.
    void leave_out(std::uint32_t first, std::uint32_t& pending, std::uint32_t& in_part) const {
        for (std::uint32_t rest = pending; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
            const std::uint32_t begin = first_surfel(first + i), end = end_surfel(first + i);
            const auto next =
                std::ranges::upper_bound(view_.left_out, begin, {}, [](const auto& range) { return range.second; });
            if (next == view_.left_out.end() || next->first >= end) continue;
            if (next->first <= begin && next->second >= end)
                pending &= ~(1u << i);
            else
                in_part |= 1u << i;
        }
    }

    const PointHierarchy& hierarchy_;
    const CutView& view_;
    SiblingJudge judge_;
};

// Runs as they grow; the last is written when the next begins.
class Runs {
  public:
    void add(std::uint32_t first, std::uint32_t count, bool inner, bool fits_point, std::uint32_t level) {
        if (open_.count != 0 && open_.first + open_.count == first && open_.inner == inner &&
            open_.fits_point == fits_point && open_.level == level) {
            open_.count += count;
            return;
        }
        close();
        open_ = {first, count, inner, fits_point, level};
    }

    std::vector<CutRun> take() {
        close();
        open_ = {};
        return std::move(closed_);
    }

    struct Mark {
        std::size_t closed;
        CutRun open;
    };
    Mark mark() const { return {closed_.size(), open_}; }
    void go_back(const Mark& mark) {
        closed_.resize(mark.closed);
        open_ = mark.open;
    }

  private:
    void close() {
        if (open_.count != 0) closed_.push_back(open_);
    }

    std::vector<CutRun> closed_;
    CutRun open_;
};

// One subtree, depth first.
class Walk {
  public:
    explicit Walk(const Rules& rules) : rules_(rules) {}

    void run(const Siblings& root) { run(root, std::numeric_limits<double>::infinity()); }

    // One level of it: `descend` is called, in order, with what is below and all that comes before that.
    template <typename Descend>
    void step(const Siblings& siblings, const Descend& descend) {
        Fates fates = rules_.decide(siblings, statistics_);
        while (fates.pending != 0)
            if (const int i = advance(siblings, fates); i >= 0)
                descend(take(), rules_.children_of(siblings, fates, static_cast<std::uint32_t>(i)));
    }

    LodCut take() {
        LodCut cut{runs_.take(), std::move(triangle_patches_), statistics_};
        triangle_patches_.clear();
        statistics_ = {};
        return cut;
    }

  private:
    struct Frame {
        Siblings siblings;
        Fates fates;
    };

    double elements() const { return static_cast<double>(statistics_.ellipses + statistics_.surfels); }

    // False if it ended because the cut has more than `most` elements.
    bool run(const Siblings& root, double most) {
        const std::size_t base = stack_.size();
        Siblings siblings = root;
        Fates fates = rules_.decide(siblings, statistics_);
        while (true) {
            while (fates.pending != 0) {
                const int i = advance(siblings, fates);
                if (i < 0) continue;
                if (fates.pending != 0) stack_.push_back({siblings, fates});
                siblings = rules_.children_of(siblings, fates, static_cast<std::uint32_t>(i));
                fates = rules_.decide(siblings, statistics_);
            }
            if (elements() > most) {
                stack_.resize(base);
                return false;
            }
            if (stack_.size() == base) return true;
            siblings = stack_.back().siblings;
            fates = stack_.back().fates;
            stack_.pop_back();
        }
    }

    // Deals with the next of siblings, and with those beside it of the same fate; or says which is to be descended
    // into.
    int advance(const Siblings& siblings, Fates& fates) {
        const int i = std::countr_zero(fates.pending);
        const std::uint32_t bit = 1u << i, node = siblings.first + static_cast<std::uint32_t>(i);
        if (((fates.ellipses | fates.surfels) & bit) == 0) {
            fates.pending ^= bit;
            if ((fates.choices & bit) == 0) return i;
            choose({node, 1, siblings.level, (fates.inside & bit) != 0, true});
            return -1;
        }
        const bool inner = (fates.ellipses & bit) != 0, fits = (fates.fits & bit) != 0;
        const std::uint32_t alike = (inner ? fates.ellipses : fates.surfels) & (fits ? fates.fits : ~fates.fits);
        // From the lowest pending bit on, up to the first that is not alike.
        const std::uint32_t run = alike & ~(alike + bit);
        const std::uint32_t end = siblings.first + static_cast<std::uint32_t>(std::bit_width(run));
        fates.pending &= ~run;
        const std::uint32_t first = rules_.first_surfel(node), surfels = rules_.end_surfel(end - 1) - first;
        if (inner) {
            statistics_.ellipses += end - node;
            statistics_.merged_surfels += surfels;
            runs_.add(node, end - node, true, fits, siblings.level);
        } else {
            statistics_.surfels += surfels;
            runs_.add(first, surfels, false, fits, 0);
        }
        return -1;
    }

    // Triangles or surfels for the patch of a node.
    void choose(const Siblings& patch_node) {
        const std::uint32_t patch = rules_.patch_of(patch_node.first);
        const double cost = rules_.triangle_cost(patch);
        const CutStatistics before = statistics_;
        const Runs::Mark mark = runs_.mark();
        // Surfels would be one at least.
        const bool within = cost >= 1 && run(patch_node, elements() + cost);
        // The patch itself was visited twice.
        const std::uint64_t visited = statistics_.visited - (cost >= 1 ? 1 : 0);
        if (!within) {
            runs_.go_back(mark);
            statistics_ = before;
            triangle_patches_.push_back(patch);
            ++statistics_.patches_by_triangles;
        }
        statistics_.visited = visited;
    }

    const Rules& rules_;
    Runs runs_;
    std::vector<std::uint32_t> triangle_patches_;
    CutStatistics statistics_;
    std::vector<Frame> stack_;
};

}  // namespace

CutStatistics& CutStatistics::operator+=(const CutStatistics& other) {
    visited += other.visited;
    outside_frustum += other.outside_frustum;
    facing_away += other.facing_away;
    ellipses += other.ellipses;
    merged_surfels += other.merged_surfels;
    surfels += other.surfels;
    patches_by_triangles += other.patches_by_triangles;
    groups_by_triangles += other.groups_by_triangles;
    return *this;
}

LodCut cut_points(const PointHierarchy& hierarchy, const CutView& view) {
    LodCut cut;
    if (hierarchy.empty()) return cut;
    const Rules rules(hierarchy, view);
    // What is decided and what is not yet, in order: cuts, each with what comes after it.
    struct Task {
        LodCut before;
        Siblings after;  // none: nothing
    };
    std::vector<Task> tasks(1);
    tasks.front().after = {0, 1, 1, false, false};
    for (int round = 0; round < kMostRounds && tasks.size() < kTasks; ++round) {
        std::vector<Task> next;
        for (Task& task : tasks) {
            if (task.after.count == 0) {
                next.push_back(std::move(task));
                continue;
            }
            next.push_back({std::move(task.before), {}});
            Walk walk(rules);
            walk.step(task.after, [&](LodCut before, const Siblings& below) {
                next.push_back({std::move(before), below});
            });
            next.push_back({walk.take(), {}});
        }
        tasks = std::move(next);
    }
    std::vector<LodCut> after(tasks.size());
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
        if (tasks[i].after.count == 0) return;
        Walk walk(rules);
        walk.run(tasks[i].after);
        after[i] = walk.take();
    });
    const auto append = [&](const LodCut& part) {
        cut.runs.insert(cut.runs.end(), part.runs.begin(), part.runs.end());
        cut.triangle_patches.insert(cut.triangle_patches.end(), part.triangle_patches.begin(),
                                    part.triangle_patches.end());
        cut.statistics += part.statistics;
    };
    std::size_t runs = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        runs += tasks[i].before.runs.size() + after[i].runs.size();
    cut.runs.reserve(runs);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        append(tasks[i].before);
        append(after[i]);
    }
    return cut;
}

}  // namespace splice
