// The picture to an image of the same size and texels that outlives the frame.
#pragma once

#include "engine/render_graph/graph.h"

#include <cstdint>

namespace splice {

void add_copy(graph::Graph& graph, graph::ImageHandle picture, graph::ImageHandle destination, std::uint32_t width,
              std::uint32_t height);

}  // namespace splice
