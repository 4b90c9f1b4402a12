// Bounds of surfels that follow one another in a model's buffer, where files keep neighbours together. Made once a
// model, they tell for a view that none of them can be seen, or that each of them can, without a look at any: from a
// camera that sees a closed surface whole, half of the surfels face away.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/splat_reach.h"
#include "preprocess/model_format/model.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// How many follow one another; the last of a model may be fewer.
inline constexpr std::uint32_t kBoundedSurfels = 64;

/// Unit-box units. Records that are no numbers have bounds that nothing is known from.
struct SurfelBounds {
    glm::vec3 centre{0};
    float radius = 0;   // of the ball around it that holds the centres
    float largest = 0;  // radius of a disk, at most
    // A cone that holds the normals of the disks' planes.
    glm::vec3 axis{0, 0, 1};
    float spread_cosine = -1, spread_sine = 0;  // of half its angle
};

/// Of a model's surfels and of `more` behind them, kBoundedSurfels each. The same for any thread count.
std::vector<SurfelBounds> bound_surfels(const ModelView& model, std::span<const format::Surfel> more);

enum class Sight { kNone, kSome, kAll };

/// What splat_setup.comp would find of surfels: never kNone where it keeps one, never kAll where it leaves one out. In
/// doubt, which rounding in single precision makes wider, kSome.
class SurfelSight {
  public:
    /// `scale`: world units a unit-box unit. `horizon`: cosine between the normal and the direction from the eye below
    /// which nothing faces away.
    SurfelSight(const Camera& camera, std::uint32_t width, std::uint32_t height, const glm::dmat4& model_to_view,
                double scale, bool two_sided, double horizon = -kHorizon);
    Sight of(const SurfelBounds& bounds) const;

  private:
    Sight in_frustum(const glm::dvec3& centre, double radius, double reach) const;
    Sight facing(const glm::dvec3& centre, double radius, const SurfelBounds& bounds) const;

    glm::dmat4 model_to_view_;
    double scale_, translation_;
    bool two_sided_, orthographic_;
    double near_plane_;
    double least_cosine_, least_sine_, most_cosine_, most_sine_;  // of the horizon's angle, less and more slack
    glm::dvec2 half_;     // of the picture and what splats reach beyond it, at depth 1 or anywhere
    glm::dvec2 to_side_;  // from how far a point is beyond it to the distance from its plane
};

}  // namespace splice
