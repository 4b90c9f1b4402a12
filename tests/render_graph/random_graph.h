// Random frames for property tests, built from a tape of numbers so that a failing one can shrink.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace splice::test {

/// Declares a valid frame of at most tape.size() / 3 + 1 passes. Everything the graph knows occurs: all kinds of passes
/// and accesses, imported resources in many states, histories, side effects, images of two sizes and several formats.
/// Long frames have many resources, most of them transient and in use for a part of the frame.
/// `record` gives each pass its record function; empty: none.
void declare_random(graph::Graph& graph, const std::vector<uint32_t>& tape,
                    const std::function<graph::RecordFunction(uint32_t pass)>& record = {});

/// The same numbers for the same seed on every machine.
std::vector<uint32_t> random_tape(size_t length, uint32_t seed);

/// Made-up sizes of the resources, log-uniform from 256 bytes to 16 MiB; for three seeds of four in one
/// memory type, else in two.
std::vector<graph::MemoryRequirement> random_sizes(const graph::Graph& graph, uint32_t seed);

}  // namespace splice::test
