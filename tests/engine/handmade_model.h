// Small models written by hand, in view of what a test wants to see: single disks, sheets, quads of triangles.
#pragma once

#include "preprocess/model_format/model.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace splice::test {

struct Disk {
    glm::vec3 centre;
    glm::vec3 normal;  // need not be unit
    float radius;
    float epsilon;
    std::uint32_t colour = 0xffffffff;  // sRGB RGBA8, R in the lowest byte
    float above = 0, below = 0;         // see preprocess/model_format/surfel_extent.h
    std::uint16_t clip = 0;             // preprocess/model_format/surfel_clip.h
};

struct Corner {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 uv{0};
    std::uint32_t colour = 0xffffffff;
};

inline constexpr std::uint32_t kRed = 0xff0000ff, kGreen = 0xff00ff00, kBlue = 0xffff0000;

/// Unit-box units are source units here: no scaling, no offset.
class HandmadeModel {
  public:
    explicit HandmadeModel(bool two_sided = false);

    /// One surfel patch holding all of `disks`.
    HandmadeModel& add_surfels(const std::vector<Disk>& disks);
    /// One triangle patch; each three corners are a triangle, counter-clockwise from the front.
    HandmadeModel& add_triangles(const std::vector<Corner>& corners, std::uint32_t material = 0);
    /// A texture of one level, RGBA8; returns the material that shows it.
    std::uint32_t add_texture(std::uint32_t width, std::uint32_t height, const std::vector<std::uint32_t>& texels);

    const Model& model();

  private:
    void extend(format::Patch& patch, const glm::vec3& point, float radius);

    Model model_;
};

/// Two triangles: origin, origin + along, origin + along + up, origin + up; the normal is along x up.
std::vector<Corner> quad(const glm::vec3& origin, const glm::vec3& along, const glm::vec3& up,
                         std::uint32_t colour = 0xffffffff);

/// A square lattice of disks over the same parallelogram, `count` a side, radii that leave no hole.
std::vector<Disk> sheet(const glm::vec3& origin, const glm::vec3& along, const glm::vec3& up, int count,
                        std::uint32_t colour = 0xffffffff);

}  // namespace splice::test
