// What merging two clusters costs, in the forms that the phases use (see merge_heap.h for the interface). All are sums
// of dimensionless terms in unit-box units; smaller merges first.
#pragma once

#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/merge_heap.h"
#include "preprocess/cluster/quadric.h"
#include "preprocess/cluster/shape.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace splice {

/// The additive data that every metric asks for, half a cache line a cluster.
struct alignas(32) Cluster {
    Shape shape;
    float irregularity = 1;
    std::uint32_t faces = 1;
    Vec3f normal_sum = Vec3f::Zero();  // area weighted
    float score_sum = 0;               // area weighted, see selection.h
};
static_assert(sizeof(Cluster) == 32);

/// All clusters by slot. Both phases work on the same table.
class ClusterTable {
  public:
    explicit ClusterTable(const FaceGraph& faces, const std::vector<float>& scores = {}) : clusters_(faces.size()) {
        for (std::size_t s = 0; s < faces.size(); ++s) {
            const Shape shape{faces.area[s], faces.perimeter[s]};
            clusters_[s] = {shape, shape.irregularity(), 1, faces.area[s] * faces.normal[s],
                            scores.empty() ? 0.0f : faces.area[s] * scores[s]};
        }
    }
    explicit ClusterTable(std::vector<Cluster> clusters) : clusters_(std::move(clusters)) {}

    void prefetch(std::uint32_t slot) const { __builtin_prefetch(&clusters_[slot], 1); }
    const Cluster& operator[](std::uint32_t slot) const { return clusters_[slot]; }
    /// E_shape of merging a and b over a common border of `length`.
    float shape_cost(std::uint32_t a, std::uint32_t b, float length) const {
        const Cluster &ca = clusters_[a], &cb = clusters_[b];
        return splice::shape_cost(united(ca.shape, cb.shape, length).irregularity(), ca.irregularity, cb.irregularity);
    }
    void merge(std::uint32_t a, std::uint32_t b, float length) {
        Cluster& into = clusters_[a];
        const Cluster& gone = clusters_[b];
        into.shape = united(into.shape, gone.shape, length);
        into.irregularity = into.shape.irregularity();
        into.faces += gone.faces;
        into.normal_sum += gone.normal_sum;
        into.score_sum += gone.score_sum;
    }

    std::vector<Cluster> take() { return std::move(clusters_); }

  private:
    std::vector<Cluster> clusters_;
};

/// Phase one as published: E_fit + E_dir + E_shape, clusters up to `max_area`.
class ThesisMetric {
  public:
    ThesisMetric(const IndexedMesh& mesh, const FaceGraph& faces, ClusterTable& clusters, float max_area)
        : clusters_(clusters), max_area_(max_area), points_(faces.size()), directions_(faces.size()) {
        for (std::size_t s = 0; s < faces.size(); ++s) {
            for (const Vec3f& corner : faces.corners(mesh, s))
                points_[s] += PointQuadric::of(corner.cast<double>());
            directions_[s] = DirectionQuadric::of(faces.normal[s].cast<double>(), static_cast<double>(faces.area[s]));
        }
    }
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        return clusters_[a].shape.area + clusters_[b].shape.area > max_area_ ? kNever
                                                                             : clusters_.shape_cost(a, b, length);
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
        clusters_.merge(a, b, length);
        points_[a] += points_[b];
        directions_[a] += directions_[b];
    }

    void prefetch(std::uint32_t slot) const { clusters_.prefetch(slot); }

  private:
    ClusterTable& clusters_;
    float max_area_;
    std::vector<PointQuadric> points_;
    std::vector<DirectionQuadric> directions_;
};

/// Limits on a cluster of the geometric selection.
struct ClusterLimits {
    float max_area;  // unit-box units^2
    std::uint32_t max_faces;
    float max_spread;  // of normals, radians: sqrt(2 (1 - |area-weighted mean of unit normals|))

    bool allow_size(const Cluster& a, const Cluster& b) const {
        return a.shape.area + b.shape.area <= max_area && a.faces + b.faces <= max_faces;
    }
    /// E_turn = (spread / max_spread)^2, the variance of the union's normals; above 1 is not allowed.
    float turn(const Cluster& a, const Cluster& b) const {
        const float mean = (a.normal_sum + b.normal_sum).norm() / (a.shape.area + b.shape.area);
        return std::max(0.0f, 2 * (1 - mean) / (max_spread * max_spread));
    }
};

/// Phase one of the geometric selection: E_shape + E_turn within the limits. Clusters keep to their side of the
/// roughness threshold: flat and rough faces never meet in one.
class FlatnessMetric {
  public:
    FlatnessMetric(ClusterTable& clusters, const std::vector<std::uint8_t>& rough, const ClusterLimits& limits)
        : clusters_(clusters), rough_(rough), limits_(limits) {}
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        const Cluster &ca = clusters_[a], &cb = clusters_[b];
        if (rough_[a] != rough_[b] || !limits_.allow_size(ca, cb)) return kNever;
        const float turn = limits_.turn(ca, cb);
        return turn > 1 ? kNever : clusters_.shape_cost(a, b, length) + turn;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) { clusters_.merge(a, b, length); }

    void prefetch(std::uint32_t slot) const { clusters_.prefetch(slot); }

  private:
    ClusterTable& clusters_;
    const std::vector<std::uint8_t>& rough_;
    ClusterLimits limits_;
};

/// The end of phase one: crumbs, clusters of at most `crumb_area`, join the neighbour they suit best by E_shape. One
/// whose score is within a factor of two of the threshold may cross it; the union is on the side of its larger part.
/// Clear cases stay, however small: a narrow flat face of a machined part is drawn as triangles.
class CrumbMetric {
  public:
    CrumbMetric(ClusterTable& clusters, std::vector<std::uint8_t>& rough, float threshold, const ClusterLimits& limits,
                float crumb_area)
        : clusters_(clusters), rough_(rough), threshold_(threshold), limits_(limits), crumb_area_(crumb_area) {}
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        const Cluster &ca = clusters_[a], &cb = clusters_[b];
        const bool a_is_crumb = ca.shape.area < cb.shape.area;
        const Cluster& crumb = a_is_crumb ? ca : cb;
        if (crumb.shape.area > crumb_area_ || !limits_.allow_size(ca, cb)) return kNever;
        const bool into_rough = rough_[a_is_crumb ? b : a] != 0;
        if (!into_rough && limits_.turn(ca, cb) > 1) return kNever;
        const float score = crumb.score_sum / crumb.shape.area;
        const bool doubtful = score >= threshold_ / 2 && score <= threshold_ * 2;
        return rough_[a] == rough_[b] || doubtful ? clusters_.shape_cost(a, b, length) : kNever;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) {
        if (clusters_[a].shape.area < clusters_[b].shape.area) rough_[a] = rough_[b];
        clusters_.merge(a, b, length);
    }

    void prefetch(std::uint32_t slot) const { clusters_.prefetch(slot); }

  private:
    ClusterTable& clusters_;
    std::vector<std::uint8_t>& rough_;
    float threshold_;
    ClusterLimits limits_;
    float crumb_area_;
};

/// Phase two: E_shape + E_size, E_size = merged area / `size_unit`, clusters up to `max_area`.
class SizeMetric {
  public:
    SizeMetric(ClusterTable& clusters, float size_unit, float max_area)
        : clusters_(clusters), size_unit_(size_unit), max_area_(max_area) {}
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        const float area = clusters_[a].shape.area + clusters_[b].shape.area;
        return area > max_area_ ? kNever : clusters_.shape_cost(a, b, length) + area / size_unit_;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) { clusters_.merge(a, b, length); }

    void prefetch(std::uint32_t slot) const { clusters_.prefetch(slot); }

  private:
    ClusterTable& clusters_;
    float size_unit_;
    float max_area_;
};

}  // namespace splice
