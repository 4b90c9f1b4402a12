#include "preprocess/cluster/cluster_graph.h"

#include <algorithm>

namespace splice {

ClusterGraph::ClusterGraph(const FaceGraph& faces) : arena_(faces.size() * kQuad), slots_(faces.size()) {
    for (std::uint32_t s = 0; s < faces.size(); ++s)
        slots_[s] = {s, 0, 0, 0, s, faces.face_of_slot[s]};
    // A face has at most three neighbours, so its first block never overflows. Links come in ascending order, which
    // fills every list in ascending order too: first the neighbours below a slot, then those above.
    const auto append = [&](std::uint32_t slot, std::uint32_t neighbour, float length) {
        arena_[slot * kQuad + slots_[slot].size++] = {neighbour, length};
    };
    for (const FaceGraph::Link& l : faces.links)
        append(l.slot[1], l.slot[0], l.length);
    for (const FaceGraph::Link& l : faces.links)
        append(l.slot[0], l.slot[1], l.length);
    tree_.reserve(faces.size());
}

float ClusterGraph::border(std::uint32_t a, std::uint32_t b) const {
    const auto of_a = links(a);
    return std::lower_bound(of_a.begin(), of_a.end(), b,
                            [](const ClusterLink& l, std::uint32_t slot) { return l.slot < slot; })
        ->length;
}

std::uint32_t ClusterGraph::allocate(std::uint32_t size_class) {
    if (size_class < free_.size() && !free_[size_class].empty()) {
        const std::uint32_t block = free_[size_class].back();
        free_[size_class].pop_back();
        return block;
    }
    const auto block = static_cast<std::uint32_t>(arena_.size() / kQuad);
    arena_.resize(arena_.size() + (kQuad << size_class));
    return block;
}

void ClusterGraph::release(const Slot& slot) {
    if (free_.size() <= slot.size_class) free_.resize(slot.size_class + 1);
    free_[slot.size_class].push_back(slot.block);
}

void ClusterGraph::store(Slot& slot, std::span<const ClusterLink> links) {
    if (links.size() > (kQuad << slot.size_class)) {
        release(slot);
        while (links.size() > (kQuad << slot.size_class))
            ++slot.size_class;
        slot.block = allocate(slot.size_class);
    }
    slot.size = static_cast<std::uint32_t>(links.size());
    std::copy(links.begin(), links.end(), arena_.begin() + static_cast<std::ptrdiff_t>(slot.block * kQuad));
}

/// In the list of `slot`: `from` becomes `to`, to < from; joined if `to` is there already. The list never grows.
void ClusterGraph::rename_neighbour(std::uint32_t slot, std::uint32_t from, std::uint32_t to) {
    ClusterLink* const first = arena_.data() + slots_[slot].block * kQuad;
    ClusterLink* const last = first + slots_[slot].size;
    const auto before = [](const ClusterLink& l, std::uint32_t s) { return l.slot < s; };
    ClusterLink* const old = std::lower_bound(first, last, from, before);
    ClusterLink* const target = std::lower_bound(first, old, to, before);
    const float length = old->length;
    if (target->slot == to) {
        target->length += length;
        std::copy(old + 1, last, old);
        --slots_[slot].size;
    } else {
        std::copy_backward(target, old, old + 1);
        *target = {to, length};
    }
}

void ClusterGraph::merge(std::uint32_t a, std::uint32_t b, float cost, std::uint32_t phase) {
    merged_.clear();
    const auto of_a = links(a), of_b = links(b);
    auto ia = of_a.begin(), ib = of_b.begin();
    while (ia != of_a.end() || ib != of_b.end()) {
        if (ib == of_b.end() || (ia != of_a.end() && ia->slot < ib->slot)) {
            if (ia->slot != b) merged_.push_back(*ia);
            ++ia;
        } else if (ia == of_a.end() || ib->slot < ia->slot) {
            if (ib->slot != a) merged_.push_back(*ib);
            ++ib;
        } else {
            merged_.push_back({ia->slot, ia->length + ib->length});
            ++ia;
            ++ib;
        }
    }
    for (const ClusterLink& l : of_b) {
        if (l.slot != a) rename_neighbour(l.slot, b, a);
    }
    Slot& into = slots_[a];
    Slot& gone = slots_[b];
    release(gone);
    store(into, merged_);
    gone.size = 0;
    gone.parent = a;
    ++into.version;
    ++gone.version;
    tree_.push_back({{into.node, gone.node}, cost, phase});
    into.node = static_cast<std::uint32_t>(slots() + tree_.size() - 1);
}

}  // namespace splice
