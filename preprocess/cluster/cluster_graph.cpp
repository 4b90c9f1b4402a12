#include "preprocess/cluster/cluster_graph.h"

#include <algorithm>

namespace splice {

ClusterGraph::ClusterGraph(const FaceGraph& faces) : ClusterGraph(faces.face_of_slot, faces.links, faces.size()) {}

ClusterGraph::ClusterGraph(std::vector<std::uint32_t> nodes, std::span<const FaceGraph::Link> links, std::size_t leaves,
                           std::vector<format::MergeNode> tree)
    : leaves_(leaves),
      first_class_(2 * links.size() > kQuad * nodes.size() ? 1 : 0),
      arena_((nodes.size() * kQuad) << first_class_),
      slots_(nodes.size()),
      changed_(nodes.size(), 0),
      node_(std::move(nodes)),
      tree_(std::move(tree)) {
    for (std::uint32_t s = 0; s < slots_.size(); ++s)
        slots_[s] = {s << first_class_, 0, first_class_, s};
    for (const FaceGraph::Link& l : links) {
        append(slots_[l.slot[0]], {l.slot[1], l.length});
        append(slots_[l.slot[1]], {l.slot[0], l.length});
    }
    tree_.reserve(tree_.size() + slots_.size());
}

void ClusterGraph::append(Slot& slot, const ClusterLink& link) {
    grow(slot, slot.size + 1);
    first_link(slot)[slot.size++] = link;
}

/// Makes room for `size` links in the list of `slot`; those there are kept.
void ClusterGraph::grow(Slot& slot, std::uint32_t size) {
    std::uint32_t size_class = slot.size_class;
    while (size > (kQuad << size_class))
        ++size_class;
    if (size_class == slot.size_class) return;
    if (free_.size() <= size_class) free_.resize(size_class + 1);
    std::uint32_t block = 0;
    if (free_[size_class].empty()) {
        block = static_cast<std::uint32_t>(arena_.size() / kQuad);
        arena_.resize(arena_.size() + (kQuad << size_class));
    } else {
        block = free_[size_class].back();
        free_[size_class].pop_back();
    }
    const ClusterLink* const old = first_link(slot);
    std::copy(old, old + slot.size, arena_.data() + block * kQuad);
    free_[slot.size_class].push_back(slot.block);
    slot.block = block;
    slot.size_class = size_class;
}

/// In the list of `slot`: the neighbour `from` becomes `to`. Returns whether `to` was there already; the two are then
/// joined.
bool ClusterGraph::redirect(std::uint32_t slot, std::uint32_t from, std::uint32_t to) {
    ClusterLink* const first = first_link(slots_[slot]);
    const std::uint32_t size = slots_[slot].size;
    std::uint32_t at_from = size, at_to = size;
    for (std::uint32_t i = 0; i < size; ++i) {
        at_from = first[i].slot == from ? i : at_from;
        at_to = first[i].slot == to ? i : at_to;
    }
    if (at_to == size) {
        first[at_from].slot = to;
        return false;
    }
    first[at_to].length += first[at_from].length;
    first[at_from] = first[size - 1];
    slots_[slot].size = size - 1;
    return true;
}

float ClusterGraph::merge(std::uint32_t a, std::uint32_t b, float cost, std::uint32_t phase) {
    Slot& into = slots_[a];
    Slot& gone = slots_[b];
    const auto find = [](ClusterLink* link, std::uint32_t slot) {
        while (link->slot != slot)
            ++link;
        return link;
    };
    ClusterLink* const of_a = first_link(into);
    ClusterLink* const of_b = first_link(gone);
    ClusterLink* const between = find(of_a, b);
    const float border = between->length;
    *between = of_a[--into.size];
    // What only b touched gathers at the front of its list.
    std::uint32_t fresh = 0;
    for (std::uint32_t i = 0; i < gone.size; ++i) {
        const ClusterLink link = of_b[i];
        if (link.slot == a) continue;
        if (redirect(link.slot, b, a)) {
            find(of_a, link.slot)->length += link.length;
        } else {
            of_b[fresh++] = link;
        }
    }
    grow(into, into.size + fresh);
    const ClusterLink* const added = first_link(gone);  // growing may have moved the arena
    std::copy(added, added + fresh, first_link(into) + into.size);
    into.size += fresh;
    if (free_.size() <= gone.size_class) free_.resize(gone.size_class + 1);
    free_[gone.size_class].push_back(gone.block);
    gone.size = 0;
    gone.parent = a;
    const std::uint32_t united = next_node();
    tree_.push_back({{node_[a], node_[b]}, cost, phase});
    changed_[a] = changed_[b] = now();
    node_[a] = united;
    return border;
}

}  // namespace splice
