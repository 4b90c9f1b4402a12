// How far apart surfels should lie at each point of the surface: close where normals or colours turn, far where nothing
// happens, graded in between.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/surfel/sheet.h"
#include "preprocess/surfel/surfel_colour.h"
#include "preprocess/surfel/surfel_set.h"

#include <cstdint>
#include <vector>

namespace splice {

/// Piecewise linear over the mesh, except near features (creases of the corner normals, open borders, non-manifold
/// edges): there disks must not stick out far beyond the edge, so spacing falls towards it with the distance inside the
/// triangle.
class SpacingField {
  public:
    /// The adaptive field; reads the lengths of the options.
    SpacingField(const IndexedMesh& mesh, const SmoothNeighbours& neighbours, const SurfaceColour& colour,
                 const SamplingOptions& options);

    /// Distance wanted between neighbouring surfels at a point of triangle `t`, unit-box units.
    float at(std::uint32_t t, const Vec3f& point) const;

    /// |at(x) - at(y)| <= kGrading |x - y| inside a triangle, for the field that vertices carry nearly so everywhere.
    static constexpr float kGrading = 0.5f;

  private:
    void find_features();
    void measure_detail(const SurfaceColour& colour, const SamplingOptions& options);
    void grade(std::vector<float>& values) const;

    const IndexedMesh& mesh_;
    std::vector<float> vertex_spacing_;       // one a position
    std::vector<float> feature_distance_;     // one a position: spacing that its distance to the nearest feature allows
    std::vector<std::uint8_t> feature_edge_;  // one a triangle: bit k for the edge from corner k to k + 1
    std::vector<float> width_;                // one a triangle: spacing that the width of its sheet allows
    float feature_spacing_;
};

}  // namespace splice
