// Who had the bytes of a resource before it: those that its first use has to wait for.
#pragma once

#include "engine/render_graph/compile/compilation.h"
#include "engine/render_graph/packing/pack.h"

#include <cstdint>
#include <span>

namespace splice::graph {

/// Fills in Compilation::occupants_before of the resources of one heap, one an item. Frames follow each other: what had
/// the bytes last in a frame comes before what has them first in the next, itself included.
void find_occupants(std::span<const PackItem> items, std::span<const uint32_t> resources, Compilation& compilation);

}  // namespace splice::graph
