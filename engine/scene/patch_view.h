// A model's patches, and groups of them, as a camera sees them: whether they are in the picture, how near, how large,
// which level of triangles will do.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/draw_costs.h"
#include "preprocess/model_format/model_format.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace splice {

template <typename T>
glm::dvec3 vector_of(const T (&v)[3]) {
    return {v[0], v[1], v[2]};
}

enum class Containment { kOutside, kPartly, kInside };

class PatchView {
  public:
    struct Extent {
        Containment containment;
        double nearest;  // depth, view space
        // How many times as long as at the picture's middle a length at one depth may look, wherever in the bounds and
        // in the picture it is: towards the picture's corners rays are slanted. 1 in parallel projection.
        double stretch;
    };

    /// `scale`: world units a unit-box unit. The camera must outlive the view.
    PatchView(const Camera& camera, std::uint32_t width, std::uint32_t height, const glm::dmat4& model_to_view,
              double scale);

    const Camera& camera() const { return camera_; }
    double pixel_scale() const { return pixel_scale_; }
    double half_x() const { return half_x_; }
    double half_y() const { return half_y_; }

    /// A box of unit-box space against the frustum. The prefilter lets splats reach beyond their disks, and so beyond
    /// the box: what misses the picture by no more than that is kept.
    Extent locate(const float (&low)[3], const float (&high)[3]) const;

    /// True if every normal within `cone_cosine` of the unit axis is beyond the horizon from the eye, wherever in the
    /// bounds it sits (Pajarola et al. 2004, section 6.2, with the extent of the patch taken into account:
    /// beta + theta + alpha < 90 degrees, here less what shaders draw beyond the horizon).
    bool faces_away(const float (&cone_axis)[3], float cone_cosine, const float (&low)[3],
                    const float (&high)[3]) const;

    /// Whether a length takes at most so many pixels, whichever way, wherever in the bounds.
    bool within(double length, double pixels, const Extent& extent) const;

    /// How many of the levels, finer before coarser, are within `tau` pixels wherever in their bounds they are.
    std::size_t levels_within(std::span<const format::Lod> levels, double tau, const Extent& extent) const;

    /// Of a surface that is turned every way, half of its area as it is seen face on. 0, a cloud's, is not known: the
    /// mean silhouette of a box is a quarter of its surface.
    double pixels_of(double area, const float (&low)[3], const float (&high)[3], double nearest) const;

    /// `pixels`: of the patch or group that the level is of.
    static DrawLoad load_of_triangles(const format::Lod& level, double pixels, bool two_sided);

  private:
    const Camera& camera_;
    glm::dmat4 model_to_view_;
    double scale_;
    double pixel_scale_;      // pixels per unit at depth 1, or anywhere
    double half_x_, half_y_;  // of the picture, at depth 1 or anywhere
};

}  // namespace splice
