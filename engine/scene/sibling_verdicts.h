// What a view makes of nodes of a point tree (Pajarola et al. 2004, section 6.2), eight siblings at once: all in the
// model's unit-box space, where nodes need not be transformed, without a branch, a division or an angle: what the paper
// compares is multiplied out. In single precision; what leaves something out allows for its rounding.
#pragma once

#include "engine/scene/lod_cut.h"
#include "engine/scene/point_hierarchy.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace splice {

/// A byte a verdict, with a bit a sibling, the first's the lowest. Two words, so that they are returned in registers.
struct SiblingVerdicts {
    std::uint32_t ends = 0, sizes = 0;

    /// The frustum does not reach them.
    std::uint32_t outside() const { return ends & 255; }
    /// Every normal faces away from the eye, wherever in the sphere it is.
    std::uint32_t away() const { return ends >> 8 & 255; }
    /// At most tau pixels long.
    std::uint32_t small() const { return ends >> 16 & 255; }
    /// Their disks are wholly in the frustum.
    std::uint32_t inside() const { return ends >> 24; }
    /// No wider than the largest point: the whole sphere; its disks.
    std::uint32_t narrow() const { return sizes & 255; }
    std::uint32_t fine() const { return sizes >> 8 & 255; }
    /// Nothing below is at most tau pixels long, wherever in the sphere it is.
    std::uint32_t never() const { return sizes >> 16 & 255; }
};

class SiblingJudge {
  public:
    /// Both must outlive it.
    SiblingJudge(const PointHierarchy& hierarchy, const CutView& view);

    /// Of `count` nodes, up to kMostSiblings, from `first` on; bits of what lies beyond mean nothing.
    SiblingVerdicts judge(std::uint32_t first, std::uint32_t count) const;

  private:
    /// Four siblings at once: every processor that is meant has vectors of that width.
    static constexpr std::size_t kLanes = 4;
    using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
    using Bits = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));  // all or none of a lane's
    struct Points {
        Floats x, y, z;
    };
    struct Plane {  // of a point: dot(normal, p) + w
        Points normal;
        Floats w;
        Plane() = default;
        explicit Plane(const glm::dvec4& plane);
        Floats distance(const Points& p) const;
    };

    static Floats spread(double value);
    static Floats larger(Floats a, Floats b);
    static Floats dot(const Points& a, const Points& b);

    template <bool orthographic>
    SiblingVerdicts judge_lanes(std::size_t first) const;

    const PointHierarchy& hierarchy_;
    bool orthographic_, two_sided_;
    // The same number in every lane.
    Plane depth_;                 // unit-box units
    std::array<Plane, 4> sides_;  // what a point is beyond a side of the frustum
    Points eye_;
    Floats near_;
    Floats slack_;           // by which splats reach beyond their disks, at depth 1 or anywhere
    Floats rounding_;        // of distances from planes
    Floats longest_;         // half axis that takes tau pixels at depth 1, or anywhere
    Floats largest_point_;   // radius of a disk that fits the largest point there
    Floats largest_radius_;  // of the model's surfels
};

}  // namespace splice
