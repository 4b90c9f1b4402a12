#include "preprocess/cluster/cluster_graph.h"

#include <algorithm>
#include <numeric>

namespace splice {

ClusterGraph::ClusterGraph(const FaceGraph& faces)
    : arena_(faces.size() * kQuad),
      lists_(faces.size()),
      parent_(faces.size()),
      version_(faces.size(), 0),
      node_(faces.face_of_slot) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    // A face has at most three neighbours, so its first block never overflows. Links come in ascending order, which
    // fills every list in ascending order too: first the neighbours below a slot, then those above.
    for (std::size_t s = 0; s < faces.size(); ++s)
        lists_[s].begin = static_cast<std::uint32_t>(s);
    const auto append = [&](std::uint32_t slot, std::uint32_t neighbour, float length) {
        arena_[lists_[slot].begin * kQuad + lists_[slot].size++] = {neighbour, length};
    };
    for (const FaceGraph::Link& l : faces.links)
        append(l.slot[1], l.slot[0], l.length);
    for (const FaceGraph::Link& l : faces.links)
        append(l.slot[0], l.slot[1], l.length);
    tree_.reserve(faces.size());
}

std::uint32_t ClusterGraph::allocate(std::uint8_t size_class) {
    if (size_class < free_.size() && !free_[size_class].empty()) {
        const std::uint32_t block = free_[size_class].back();
        free_[size_class].pop_back();
        return block;
    }
    const auto block = static_cast<std::uint32_t>(arena_.size() / kQuad);
    arena_.resize(arena_.size() + (kQuad << size_class));
    return block;
}

void ClusterGraph::release(List& list) {
    if (free_.size() <= list.size_class) free_.resize(list.size_class + 1u);
    free_[list.size_class].push_back(list.begin);
    list = {};
}

void ClusterGraph::store(std::uint32_t slot, std::span<const ClusterLink> links) {
    List& list = lists_[slot];
    if (links.size() > (kQuad << list.size_class)) {
        std::uint8_t size_class = list.size_class;
        while (links.size() > (kQuad << size_class))
            ++size_class;
        release(list);
        list.begin = allocate(size_class);
        list.size_class = size_class;
    }
    list.size = static_cast<std::uint32_t>(links.size());
    std::copy(links.begin(), links.end(), arena_.begin() + static_cast<std::ptrdiff_t>(list.begin * kQuad));
}

/// In the list of `slot`: `from` becomes `to`, to < from; joined if `to` is there already. The list never grows.
void ClusterGraph::rename_neighbour(std::uint32_t slot, std::uint32_t from, std::uint32_t to) {
    List& list = lists_[slot];
    ClusterLink* const first = arena_.data() + list.begin * kQuad;
    ClusterLink* const last = first + list.size;
    const auto before = [](const ClusterLink& l, std::uint32_t s) { return l.slot < s; };
    ClusterLink* const old = std::lower_bound(first, last, from, before);
    ClusterLink* const target = std::lower_bound(first, old, to, before);
    const float length = old->length;
    if (target->slot == to) {
        target->length += length;
        std::copy(old + 1, last, old);
        --list.size;
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
    release(lists_[b]);
    store(a, merged_);
    parent_[b] = a;
    ++version_[a];
    ++version_[b];
    tree_.push_back({{node_[a], node_[b]}, cost, phase});
    node_[a] = static_cast<std::uint32_t>(slots() + tree_.size() - 1);
}

}  // namespace splice
