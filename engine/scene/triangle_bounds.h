// Bounds of triangles that follow one another in a level of a node of the octree, where files keep those together that
// lie together and face the same way (preprocess/simplify/cluster_triangles.h). Made once a model: from a camera that
// sees a closed surface whole, half of its triangles face away, and each costs its vertices and its setup.
#pragma once

#include "engine/scene/surfel_bounds.h"
#include "preprocess/model_format/model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Triangles of a run; the last of a level may have fewer. Any number is right; this is the one that files sort for.
inline constexpr std::uint32_t kBoundedTriangles = 64;

/// Cosine of the angle between a triangle's normal and the direction to it beyond which devices may take it for one
/// that faces the eye, as their coordinates are fractions of a pixel. Of triangles of a tenth of a pixel they may be
/// wrong by more: single pixels of outlines could differ by what should not have been drawn.
inline constexpr double kTriangleHorizon = 0.01;

/// Of all levels of an octree's nodes.
class TriangleBounds {
  public:
    TriangleBounds() = default;
    explicit TriangleBounds(const ModelView& model);

    /// Of a level's runs; `level`: its index among the model's. None where it is no node's.
    std::span<const SurfelBounds> of(std::uint32_t level) const {
        if (first_run_.empty()) return {};
        return std::span(runs_).subspan(first_run_[level], first_run_[level + 1] - first_run_[level]);
    }

  private:
    std::vector<std::size_t> first_run_;  // of each level; one more
    std::vector<SurfelBounds> runs_;      // `largest` is 0
};

}  // namespace splice
