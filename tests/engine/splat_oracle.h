// What a pixel of a splat must be, in double precision, from the definitions: rays are intersected with planes as they
// come, the projection is differentiated numerically, matrices are inverted. Shares no formula with splat.glsl.
#pragma once

#include "engine/scene/camera.h"
#include "tests/engine/handmade_model.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace splice::test {

struct SplatPixel {
    bool on_disk = false;  // the ray of the pixel's centre meets the disk in front of the near plane
    bool between = false;  // the disk is narrower than a pixel, lies between pixel centres and has its centre here
    double depth = 0;      // where the ray meets the disk, or of the centre
    double weight = 0;     // EWA; 0 beyond the cut
    double certainty = 0;  // how far, relatively, the decisions above are from turning
};

class SplatOracle {
  public:
    SplatOracle(const Disk& disk, const Camera& camera, std::uint32_t width, std::uint32_t height, bool prefilter);
    SplatPixel at(std::uint32_t x, std::uint32_t y) const;

  private:
    struct Meeting {
        double depth;
        double distance2;  // from the centre, in radii
    };
    std::optional<Meeting> meet(const glm::dvec2& pixel) const;
    glm::dvec2 window(const glm::dvec3& view_point) const;

    Camera camera_;
    double width_, height_, scale_;
    bool prefilter_;
    glm::dvec3 centre_, normal_;  // view space
    double radius_;
    bool crosses_near_ = false;
    bool sub_pixel_ = false;
    glm::dvec2 centre_px_{0};
    glm::dmat2 covariance_inverse_{0};
    double peak_ = 1;
};

}  // namespace splice::test
