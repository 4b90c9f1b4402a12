// Triangles of one surface wound the same way.
#pragma once

#include "preprocess/mesh/edge_table.h"

namespace splice {

/// For each connected component (across edges of two triangles) that is inconsistently wound but orientable: marks the
/// minority for turning, or, where the component is closed and would come out inside out, the others. Consistent and
/// non-orientable components (a Moebius strip) are left alone. Returns one flag a triangle.
std::vector<std::uint8_t> find_flipped_triangles(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                                 const EdgeTable& edges);

/// True for a closed and consistently wound surface that encloses a negative volume: all of its triangles face inwards.
/// Cavities count against what surrounds them, so hollow bodies are judged by their outside.
bool is_inside_out(std::span<const Vec3f> positions, std::span<const Triangle> triangles, const EdgeTable& edges);

}  // namespace splice
