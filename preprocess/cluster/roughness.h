// How much the surface varies around each place, at one fixed scale of the model.
#pragma once

#include "preprocess/cluster/face_graph.h"

#include <cstdint>
#include <vector>

namespace splice {

/// Radius of the ball in which normals are compared, unit-box units.
inline constexpr float kRoughnessRadius = 0.02f;

/// The spread of a set of normals in radians, 0 to sqrt 2: sqrt(2 (1 - |area-weighted mean of the unit normals|)),
/// which for small spreads is their RMS angle to the mean.
inline float normal_spread(const Vec3f& area_weighted_sum, float area) {
    return std::sqrt(std::max(0.0f, 2 * (1 - area_weighted_sum.norm() / area)));
}

/// One value a slot; large faces take the mean over their area.
struct FaceRoughness {
    std::vector<float> ball;  // spread over all surface in the ball, other sheets and far sides of creases included
    std::vector<float>
        triangles;  // how many of the ball's triangles fit on a disk of its radius: low for coarse meshes
};

/// The surface summed into grid cells of a third of the radius, apart for different directions, so that neighbourhoods
/// are compared cell by cell and not face by face. O(faces + area / radius^2) to build; deterministic for any number of
/// threads.
class SurfaceGrid {
  public:
    SurfaceGrid(const IndexedMesh& mesh, const FaceGraph& faces);

    /// `faces` as given to the constructor.
    FaceRoughness measure(const FaceGraph& faces) const;

    /// The spread of the part of the surface in the ball around `centre` that faces within `cone` radians of `normal`;
    /// 0 if there is none.
    float sheet_spread(const Vec3f& centre, const Vec3f& normal, float cone) const;

  private:
    /// The surface inside one grid cell that faces one way.
    struct Cell {
        Vec3f position = Vec3f::Zero();    // area-weighted mean
        Vec3f normal_sum = Vec3f::Zero();  // area weighted
        Vec3f direction = Vec3f::Zero();   // unit
        float area = 0;
        float triangles = 0;  // fractions of them
    };
    template <class Visit>
    void for_each_in_ball(const Vec3f& centre, const Visit& visit) const;

    std::vector<Cell> cells_;                  // by block of one radius
    std::vector<std::uint32_t> block_begin_;   // into cells_
    std::vector<std::uint32_t> sample_begin_;  // by slot: faces are cut into samples of about one cell
    std::vector<std::uint32_t> cell_of_sample_;
};

}  // namespace splice
