// The order of half-edge collapses: a vertex waits with its cheapest collapse, and whether that is legal is asked only
// when it is the cheapest of all. Ties go by number, so that the order is the same each time.
#pragma once

#include "preprocess/simplify/collapse_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splice {

/// `Simplifier` derives from this and has may_move(vertex), list_targets(vertex), which fills targets_,
/// is_legal(vertex, target) and collapse(vertex, target), which pushes what it changed.
template <typename Simplifier>
class CollapseQueue : protected CollapseMesh {
  protected:
    struct Target {
        double cost;
        Index vertex;
    };

    using CollapseMesh::CollapseMesh;

    void fill_queue() {
        version_.assign(position_.size(), 0);
        heap_.clear();
        for (Index vertex = 0; vertex < position_.size(); ++vertex)
            push_candidate(vertex);
        std::make_heap(heap_.begin(), heap_.end(), goes_later);
    }

    /// As long as there are collapses and `more()`.
    template <typename More>
    void collapse_while(const More& more) {
        while (!heap_.empty() && more()) {
            std::pop_heap(heap_.begin(), heap_.end(), goes_later);
            const Candidate candidate = heap_.back();
            heap_.pop_back();
            if (candidate.version != version_[candidate.vertex]) continue;
            const std::size_t before_push = heap_.size();
            take(candidate);
            for (std::size_t size = before_push + 1; size <= heap_.size(); ++size)
                std::push_heap(heap_.begin(), heap_.begin() + static_cast<std::ptrdiff_t>(size), goes_later);
        }
    }
    bool queue_is_empty() const { return heap_.empty(); }

    /// Appends to the heap's array without restoring its order: collapse_while does that.
    void push_candidate(Index vertex) {
        ++version_[vertex];
        if (!self().may_move(vertex) || degree_[vertex] > kMaxDegree) return;
        self().list_targets(vertex);
        if (targets_.empty()) return;
        const Target& best = *std::ranges::min_element(targets_, is_cheaper);
        heap_.push_back({best.cost, vertex, best.vertex, version_[vertex], false});
    }
    /// Of a vertex that is no more.
    void drop_candidate(Index vertex) { ++version_[vertex]; }

    std::vector<Target> targets_;

  private:
    // A vertex's cheapest collapse when it was pushed; stale when the version has moved on.
    struct Candidate {
        double cost;
        Index vertex, target;
        std::uint32_t version;
        bool legal;  // the target has been checked
    };

    static bool is_cheaper(const Target& a, const Target& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.vertex < b.vertex;
    }
    static bool goes_later(const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost > b.cost : a.vertex > b.vertex;
    }
    Simplifier& self() { return static_cast<Simplifier&>(*this); }

    // When the target is refused, the vertex waits again with the cheapest legal one; without any, until its
    // surroundings change.
    void take(const Candidate& candidate) {
        if (candidate.legal || self().is_legal(candidate.vertex, candidate.target)) {
            self().collapse(candidate.vertex, candidate.target);
            return;
        }
        self().list_targets(candidate.vertex);
        std::ranges::sort(targets_, is_cheaper);
        for (const Target& target : targets_) {
            if (target.vertex == candidate.target || !self().is_legal(candidate.vertex, target.vertex)) continue;
            heap_.push_back({target.cost, candidate.vertex, target.vertex, candidate.version, true});
            return;
        }
    }

    std::vector<std::uint32_t> version_;  // one a local vertex
    std::vector<Candidate> heap_;
};

}  // namespace splice
