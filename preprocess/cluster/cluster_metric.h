// What merging two clusters costs, in the three forms that the phases use (see merge_heap.h for the interface). All are
// sums of dimensionless terms in unit-box units; smaller merges first.
#pragma once

#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/merge_heap.h"
#include "preprocess/cluster/quadric.h"
#include "preprocess/cluster/shape.h"

#include <cmath>
#include <vector>

namespace splice {

/// Shapes of all clusters by slot, with the irregularity that every cost asks for.
class ShapeTable {
  public:
    explicit ShapeTable(const FaceGraph& faces) : entries_(faces.size()) {
        for (std::size_t s = 0; s < faces.size(); ++s)
            set(s, {faces.area[s], faces.perimeter[s]});
    }
    float area(std::size_t slot) const { return entries_[slot].shape.area; }
    float cost(std::size_t a, std::size_t b, float length) const {
        return shape_cost(united(entries_[a].shape, entries_[b].shape, length).irregularity(), entries_[a].irregularity,
                          entries_[b].irregularity);
    }
    void merge(std::size_t a, std::size_t b, float length) {
        set(a, united(entries_[a].shape, entries_[b].shape, length));
    }

  private:
    struct Entry {
        Shape shape;
        float irregularity;
    };
    void set(std::size_t slot, const Shape& shape) { entries_[slot] = {shape, shape.irregularity()}; }
    std::vector<Entry> entries_;
};

/// Phase one as published: E_fit + E_dir + E_shape, clusters up to `max_area`.
class ThesisMetric {
  public:
    ThesisMetric(const IndexedMesh& mesh, const FaceGraph& faces, ShapeTable& shapes, float max_area)
        : shapes_(shapes), max_area_(max_area), points_(faces.size()), directions_(faces.size()) {
        for (std::size_t s = 0; s < faces.size(); ++s) {
            for (const Vec3f& corner : faces.corners(mesh, s))
                points_[s] += PointQuadric::of(corner.cast<double>());
            directions_[s] = DirectionQuadric::of(faces.normal[s].cast<double>(), faces.area[s]);
        }
    }
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        return shapes_.area(a) + shapes_.area(b) > max_area_ ? kNever : shapes_.cost(a, b, length);
    }
    float cost(std::uint32_t a, std::uint32_t b, float bound) const {
        PointQuadric points = points_[a];
        points += points_[b];
        DirectionQuadric directions = directions_[a];
        directions += directions_[b];
        const Plane plane = points.best_fit(directions.b);
        return static_cast<float>(static_cast<double>(bound) + points.mean_squared_distance(plane) +
                                  directions.deviation(plane.normal));
    }
    void merge(std::uint32_t a, std::uint32_t b, float length) {
        shapes_.merge(a, b, length);
        points_[a] += points_[b];
        directions_[a] += directions_[b];
    }

  private:
    ShapeTable& shapes_;
    float max_area_;
    std::vector<PointQuadric> points_;
    std::vector<DirectionQuadric> directions_;
};

/// Limits on a cluster of the geometric selection.
struct ClusterLimits {
    float max_area;  // unit-box units^2
    std::uint32_t max_faces;
    float max_spread;  // of normals, radians: sqrt(2 (1 - |area-weighted mean of unit normals|))
};

/// Phase one of the geometric selection: E_shape + E_turn, where E_turn = (spread / max_spread)^2, 0 to 1, is the
/// variance of the normals. Clusters keep within the limits and on their side of the roughness threshold: flat and
/// rough faces never meet in a cluster.
class FlatnessMetric {
  public:
    FlatnessMetric(const FaceGraph& faces, ShapeTable& shapes, const std::vector<std::uint8_t>& rough,
                   const ClusterLimits& limits)
        : shapes_(shapes), rough_(rough), limits_(limits), clusters_(faces.size()) {
        for (std::size_t s = 0; s < faces.size(); ++s)
            clusters_[s] = {faces.area[s] * faces.normal[s], 1};
    }
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        const float area = shapes_.area(a) + shapes_.area(b);
        if (area > limits_.max_area || rough_[a] != rough_[b] ||
            clusters_[a].faces + clusters_[b].faces > limits_.max_faces) {
            return kNever;
        }
        const float mean_length = (clusters_[a].normal_sum + clusters_[b].normal_sum).norm() / area;
        const float turn = std::max(0.0f, 2 * (1 - mean_length) / (limits_.max_spread * limits_.max_spread));
        return turn > 1 ? kNever : shapes_.cost(a, b, length) + turn;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) {
        shapes_.merge(a, b, length);
        clusters_[a].normal_sum += clusters_[b].normal_sum;
        clusters_[a].faces += clusters_[b].faces;
    }

  private:
    struct Cluster {
        Vec3f normal_sum = Vec3f::Zero();  // area weighted
        std::uint32_t faces = 0;
    };
    ShapeTable& shapes_;
    const std::vector<std::uint8_t>& rough_;
    ClusterLimits limits_;
    std::vector<Cluster> clusters_;
};

/// Phase two: E_shape + E_size, E_size = merged area / `size_unit`, clusters up to `max_area`.
class SizeMetric {
  public:
    SizeMetric(ShapeTable& shapes, float size_unit, float max_area)
        : shapes_(shapes), size_unit_(size_unit), max_area_(max_area) {}
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        const float area = shapes_.area(a) + shapes_.area(b);
        return area > max_area_ ? kNever : shapes_.cost(a, b, length) + area / size_unit_;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) { shapes_.merge(a, b, length); }

  private:
    ShapeTable& shapes_;
    float size_unit_;
    float max_area_;
};

}  // namespace splice
