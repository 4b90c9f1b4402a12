// Frames of a given number of passes, one family a shape that frames have: to measure how compilation and its results
// grow.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace splice::test {

enum class Family {
    chain,           ///< each pass reads what the one before wrote
    fan,             ///< one pass, many that read it, one that reads them all
    lattice,         ///< diamonds: 8 wide, each pass reads two neighbours of the row above
    layered_random,  ///< layers of 8; each pass reads 2 or 3 images of the last three layers and writes 1 or 2
    deferred,        ///< views with shadow, geometry, lighting and a chain of post-processing each
};
inline constexpr Family kFamilies[] = {Family::chain, Family::fan, Family::lattice, Family::layered_random,
                                       Family::deferred};
std::string_view name_of(Family family);

/// About `passes` passes, the last of which writes an imported image. Equal arguments declare equal frames.
void declare_family(graph::Graph& graph, Family family, uint32_t passes, uint32_t seed);

/// Sizes of the resources, log-uniform from 4 KiB to 64 MiB in units of `alignment` bytes; one memory type.
std::vector<graph::MemoryRequirement> log_uniform_sizes(const graph::Graph& graph, uint32_t seed, uint64_t alignment);

}  // namespace splice::test
