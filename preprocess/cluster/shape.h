// How round a cluster is, and what merging does to it (Garland, Willmott and Heckbert 2001, 4.3).
#pragma once

#include <algorithm>
#include <numbers>

namespace splice {

struct Shape {
    float area = 0;
    float perimeter = 0;

    /// perimeter^2 / (4 pi area), 1 for a disk. Clamped from below: a closed cluster has no perimeter, and rounding may
    /// leave it a small negative one.
    float irregularity() const {
        return std::max(1.0f, perimeter * perimeter / (4 * std::numbers::pi_v<float> * area));
    }
};

/// Of two clusters with a common border of `length`.
inline Shape united(const Shape& a, const Shape& b, float length) {
    return {a.area + b.area, std::max(0.0f, a.perimeter + b.perimeter - 2 * length)};
}

/// E_shape = (gamma - max(gamma_a, gamma_b)) / gamma: below 0 when the union is rounder than the worse of the two;
/// below 1.
inline float shape_cost(float irregularity_union, float irregularity_a, float irregularity_b) {
    return (irregularity_union - std::max(irregularity_a, irregularity_b)) / irregularity_union;
}

}  // namespace splice
