// Two tangents of a unit normal, a right-handed frame (s, t, n): Duff et al. 2017, "Building an orthonormal basis,
// revisited". shaders/glsl/include/splat.glsl computes the same from the same bits, for Surfel::shading_bend.
#pragma once

#include <array>

namespace splice {

struct TangentFrame {
    std::array<float, 3> s, t;
};

inline TangentFrame tangents_of(const std::array<float, 3>& n) {
    const float side = n[2] >= 0 ? 1.0f : -1.0f;
    const float a = -1 / (side + n[2]);
    const float b = n[0] * n[1] * a;
    return {{1 + side * n[0] * n[0] * a, side * b, -side * n[0]}, {b, side + n[1] * n[1] * a, -n[1]}};
}

}  // namespace splice
