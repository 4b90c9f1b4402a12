// What colour a surfel has: material times vertex colour times texture, averaged in linear light over the surface it
// stands for.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splice {

/// Linear-light RGB, each weighted by alpha, and alpha.
using LinearColour = Eigen::Array4f;

class SurfaceColour {
  public:
    explicit SurfaceColour(const IndexedMesh& mesh);

    /// True when the colour varies inside the material, so that averaging is worth the time.
    bool varies(std::uint32_t material) const;

    /// True when an image colours the triangle.
    bool textured(std::uint32_t triangle) const;

    /// Colour of a triangle's point, textures (which wrap) filtered over a square of side `footprint` (unit-box units).
    LinearColour at(std::uint32_t triangle, const Vec3f& barycentric, float footprint) const;

    /// sRGB RGBA8, R in the lowest byte.
    static std::uint32_t encode(const LinearColour& colour);

  private:
    struct Level {
        std::uint32_t width, height;
        std::vector<std::uint8_t> rgba;
    };
    LinearColour texture(std::uint32_t image, std::uint32_t triangle, const Vec3f& barycentric, float footprint) const;

    const IndexedMesh& mesh_;
    std::vector<std::vector<Level>> pyramids_;  // one an image; levels above the image itself, each half the one before
};

}  // namespace splice
