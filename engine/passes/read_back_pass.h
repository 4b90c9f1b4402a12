// The picture to host-visible memory, tightly packed rows.
#pragma once

#include "engine/render_graph/graph.h"

#include <cstdint>

namespace splice {

/// `destination` must hold width * height texels of the picture's format.
void add_read_back(graph::Graph& graph, graph::ImageHandle picture, graph::BufferHandle destination,
                   std::uint32_t width, std::uint32_t height);

}  // namespace splice
