// An oracle that shares no code with the renderer: Embree casts rays at the original triangles and says, for each
// pixel, where the surface is and what it looks like. Tests and splice-bench only.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "tests/reference/images.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>

namespace splice::reference {

/// The camera that made the frame to compare with.
struct ReferenceView {
    glm::dmat4 view{1};  // the mesh's space -> eye space, looking down -z; rotation, translation, uniform scale
    glm::dmat4 projection{
        1};  // eye space -> Vulkan's clip space (y down); perspective or orthographic, depth either way
    std::uint32_t width = 0, height = 0;

    bool perspective() const { return projection[2][3] != 0; }
};

/// In eye space. Distances along `direction` are distances along the ray, which is of unit length.
struct Ray {
    glm::dvec3 origin, direction;
};

/// The ray through window position (x, y) in pixels, y down; pixel centres are at halves. A perspective ray starts at
/// the eye, an orthographic one in the plane of the eye.
Ray pixel_ray(const ReferenceView& view, double x, double y);

/// What a ray hit.
struct SurfacePoint {
    glm::vec3 position;  // mesh space
    glm::vec3 normal;    // unit, interpolated from the corners; not turned towards the eye
    glm::vec3 to_eye;    // unit
    glm::vec3 colour;    // linear light; material, corner colour and texture (bilinear, finest level) multiplied
};

/// Linear light that leaves a surface point towards the eye.
using Shader = std::function<glm::vec3(const SurfacePoint&)>;

class ReferenceScene {
  public:
    /// The mesh must outlive the scene. Back-facing triangles are hit like others.
    explicit ReferenceScene(const IndexedMesh& mesh);
    ~ReferenceScene();
    ReferenceScene(const ReferenceScene&) = delete;
    ReferenceScene& operator=(const ReferenceScene&) = delete;

    /// One ray a pixel, through its centre.
    DepthImage depth(const ReferenceView& view) const;

    /// Of a grid of `samples_per_side`^2 rays through one pixel, and of what rasterisers may show at its centre: they
    /// move corners by half a 256th of a pixel, so where an outline passes through the centre, either side of it, and
    /// where a wall is seen from its edge, a little of its depth either way.
    DepthRange range_in_pixel(const ReferenceView& view, std::uint32_t x, std::uint32_t y,
                              std::uint32_t samples_per_side = 16) const;

    /// `samples_per_side`^2 stratified samples a pixel, averaged in linear light over `background` (linear), then
    /// sRGB-encoded. A single sample is taken at the pixel's centre.
    ColourImage shaded(const ReferenceView& view, const Shader& shader, const glm::vec3& background,
                       std::uint32_t samples_per_side = 8) const;

    /// The nearest hit in the direction of `ray` (mesh space), or nothing.
    bool hit(const Ray& ray, const glm::vec3& to_eye, SurfacePoint& point, double& distance) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The 26 directions from the centre of a cube to its faces, edges and corners; unit.
std::vector<glm::dvec3> view_directions();

}  // namespace splice::reference
