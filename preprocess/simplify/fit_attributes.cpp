// A sample belongs to the nearest triangle that does not face the other way; the normal equations are solved by
// Gauss-Seidel iteration, which converges in a few rounds: a vertex's own weight is as large as all its neighbours'.
#include "preprocess/simplify/fit_attributes.h"

#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"

#include <nanoflann.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace splice {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Samples that are looked for one after another, each from where the last was found.
constexpr std::size_t kRun = 1024;

// Vertices whose triangles are looked at for the nearest: it need not be one of the nearest vertex's.
constexpr int kSteps = 3;

constexpr int kRounds = 6;

// Of a vertex's weight, or of what even samples would give it, if that is more: how much it holds on to what its
// quadric gave it, which decides where few samples are.
constexpr double kHold = 0.05;

// Cosine between a fitted normal and the quadric's, below which the fit is not trusted.
constexpr float kLeastCosine = 0.7f;

// Squared, in the longest of the edges around: what lies farther off has no triangle, as of a part that is gone.
constexpr float kFarthest = 4;

std::uint32_t next_in_triangle(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

using Value = Eigen::Matrix<double, 6, 1>;  // normal, colour
Value value_of(const Vec3f& normal, const Vec3f& colour) {
    Value value;
    value << normal.cast<double>(), colour.cast<double>();
    return value;
}

Vec3f normal_of(const format::Vertex& vertex) {
    return Vec3f(decode_octahedral(vertex.normal).data());
}
Vec3f colour_of(const format::Vertex& vertex) {
    const auto colour = linear_from_rgba8(vertex.colour);
    return {colour[0], colour[1], colour[2]};
}

// Barycentric coordinates of a triangle's nearest point, by the region of its plane that the sample is over (Ericson
// 2005, "Real-Time Collision Detection", section 5.1.5). All from corner a.
Vec3f nearest_in_triangle(const Vec3f& sample, const Vec3f& ab, const Vec3f& ac) {
    const float ab_ab = ab.squaredNorm(), ab_ac = ab.dot(ac), ac_ac = ac.squaredNorm();
    // Of the sample from each corner along both sides.
    const float ab_a = ab.dot(sample), ac_a = ac.dot(sample);
    if (ab_a <= 0 && ac_a <= 0) return {1, 0, 0};
    const float ab_b = ab_a - ab_ab, ac_b = ac_a - ab_ac;
    if (ab_b >= 0 && ac_b <= ab_b) return {0, 1, 0};
    const float ab_c = ab_a - ab_ac, ac_c = ac_a - ac_ac;
    if (ac_c >= 0 && ab_c <= ac_c) return {0, 0, 1};
    const float of_c = ab_a * ac_b - ab_b * ac_a;
    if (of_c <= 0 && ab_a >= 0 && ab_b <= 0) return {1 - ab_a / ab_ab, ab_a / ab_ab, 0};
    const float of_b = ab_c * ac_a - ab_a * ac_c;
    if (of_b <= 0 && ac_a >= 0 && ac_c <= 0) return {1 - ac_a / ac_ac, 0, ac_a / ac_ac};
    const float of_a = ab_b * ac_c - ab_c * ac_b, beyond_b = ac_b - ab_b, beyond_c = ab_c - ac_c;
    if (of_a <= 0 && beyond_b >= 0 && beyond_c >= 0)
        return {0, beyond_c / (beyond_b + beyond_c), beyond_b / (beyond_b + beyond_c)};
    return Vec3f(of_a, of_b, of_c) / (of_a + of_b + of_c);
}

struct Points {
    std::vector<Vec3f> at;
    std::size_t kdtree_get_point_count() const { return at.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return at[i][static_cast<Eigen::Index>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using PointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;

// Rows of what belongs to each of `count` things.
struct Rows {
    std::vector<std::uint32_t> begin, entries;

    template <typename OwnerOf>
    Rows(std::size_t count, std::size_t entry_count, const OwnerOf& owner_of) : begin(count + 1, 0) {
        for (std::uint32_t entry = 0; entry < entry_count; ++entry)
            if (owner_of(entry) != kNone) ++begin[owner_of(entry) + 1];
        for (std::size_t i = 0; i < count; ++i)
            begin[i + 1] += begin[i];
        entries.resize(begin.back());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for (std::uint32_t entry = 0; entry < entry_count; ++entry)
            if (owner_of(entry) != kNone) entries[next[owner_of(entry)]++] = entry;
    }
    std::span<const std::uint32_t> of(std::size_t i) const {
        return std::span(entries).subspan(begin[i], begin[i + 1] - begin[i]);
    }
};

// Where samples lie on a level.
class NearestTriangles {
  public:
    struct Hit {
        std::uint32_t triangle = kNone;
        Vec3f weights = Vec3f::Zero();
    };

    /// `places`: mesh position of each corner.
    NearestTriangles(const IndexedMesh& mesh, std::vector<std::uint32_t> places)
        : points_(points_at(mesh, places)),
          corners_(std::move(places)),
          around_(points_.at.size(), corners_.size(), [&](std::uint32_t corner) { return corners_[corner]; }),
          tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {
        tree_.buildIndex();
        for (std::size_t first = 0; first < corners_.size(); first += 3) {
            const Vec3f& a = points_.at[corners_[first]];
            const Vec3f ab = points_.at[corners_[first + 1]] - a, ac = points_.at[corners_[first + 2]] - a;
            triangles_.push_back({a, ab, ac, ab.cross(ac)});
        }
    }

    /// Of each `step`-th.
    std::vector<Hit> of(std::span<const SurfaceSample> samples, std::size_t step) const {
        std::vector<Hit> hits((samples.size() + step - 1) / step);
        tbb::parallel_for(std::size_t{0}, (hits.size() + kRun - 1) / kRun, [&](std::size_t run) {
            std::uint32_t vertex = 0;  // where the last one was
            for (std::size_t i = run * kRun; i < std::min(hits.size(), (run + 1) * kRun); ++i)
                hits[i] = hit(samples[step * i], vertex);
        });
        return hits;
    }

    double area(std::uint32_t triangle) const { return static_cast<double>(triangles_[triangle].cross.norm()) / 2; }

  private:
    // Makes corners indices of the points.
    static Points points_at(const IndexedMesh& mesh, std::vector<std::uint32_t>& corners) {
        std::vector<std::uint32_t> used = corners;
        std::ranges::sort(used);
        used.erase(std::ranges::unique(used).begin(), used.end());
        for (std::uint32_t& corner : corners)
            corner = static_cast<std::uint32_t>(std::ranges::lower_bound(used, corner) - used.begin());
        Points points;
        for (const std::uint32_t position : used)
            points.at.push_back(mesh.positions[position]);
        return points;
    }

    // Downhill from where the last sample was; from the nearest vertex of all, if that ends far from the sample.
    Hit hit(const SurfaceSample& sample, std::uint32_t& vertex) const {
        Near near = look_around(sample, descend(sample, vertex));
        if (!(near.distance < near.width)) {
            float distance = 0;
            tree_.knnSearch(sample.position.data(), 1, &vertex, &distance);
            near = look_around(sample, vertex);
            if (!(near.distance < kFarthest * near.width)) near.hit = {};
        }
        vertex = near.vertex;
        return near.hit;
    }

    // To a vertex that has no neighbour nearer to the sample.
    std::uint32_t descend(const SurfaceSample& sample, std::uint32_t vertex) const {
        float least = (points_.at[vertex] - sample.position).squaredNorm();
        for (std::uint32_t from = kNone; from != vertex;) {
            from = vertex;
            for (const std::uint32_t corner : around_.of(from)) {
                const std::uint32_t next = corners_[next_in_triangle(corner)];
                const float distance = (points_.at[next] - sample.position).squaredNorm();
                if (distance < least) {
                    least = distance;
                    vertex = next;
                }
            }
        }
        return vertex;
    }

    struct Near {
        Hit hit;
        std::uint32_t vertex;
        float distance = std::numeric_limits<float>::max(), width = 0;  // squares; width: of the triangles around
    };
    // The nearest of a vertex's triangles; while the nearest point lies across from the vertex, of that point's
    // nearest corner's, too.
    Near look_around(const SurfaceSample& sample, std::uint32_t vertex) const {
        Near near{.hit = {}, .vertex = vertex};
        for (int step = 0; step < kSteps; ++step) {
            for (const std::uint32_t corner : around_.of(vertex)) {
                const NearTriangle& triangle = triangles_[corner / 3];
                near.width = std::max(near.width, triangle.ab.squaredNorm());
                if (triangle.cross.dot(sample.normal) < 0) continue;
                const Vec3f from_a = sample.position - triangle.a;
                const Vec3f weights = nearest_in_triangle(from_a, triangle.ab, triangle.ac);
                const float distance = (weights[1] * triangle.ab + weights[2] * triangle.ac - from_a).squaredNorm();
                if (!(distance < near.distance)) continue;
                near.distance = distance;
                near.hit = {corner / 3, weights};
            }
            if (near.hit.triangle == kNone) return near;
            Eigen::Index heaviest = 0;
            near.hit.weights.maxCoeff(&heaviest);
            const std::uint32_t next = corners_[3 * near.hit.triangle + static_cast<std::uint32_t>(heaviest)];
            near.vertex = next;
            if (next == vertex) return near;
            vertex = next;
        }
        return near;
    }

    struct NearTriangle {
        Vec3f a, ab, ac, cross;
    };
    Points points_;
    std::vector<std::uint32_t> corners_;
    Rows around_;
    std::vector<NearTriangle> triangles_;
    PointTree tree_;
};

// The normal equations of a level's own vertices.
class LeastSquares {
  public:
    LeastSquares(const RenderVertices& vertices, const RegionTriangles& level)
        : vertices_(vertices),
          level_(level),
          first_own_(static_cast<std::uint32_t>(vertices.vertices.size())),
          corners_of_(level.vertices.size(), level.corners.size(),
                      [&](std::uint32_t corner) { return own(level.corners[corner]); }),
          weight_(level.vertices.size(), 0),
          even_weight_(level.vertices.size(), 0),
          right_(level.vertices.size(), Value::Zero()),
          shared_weight_(level.corners.size(), 0) {
        for (const format::Vertex& vertex : level.vertices)
            solution_.push_back(value_of(normal_of(vertex), colour_of(vertex)));
    }

    void add(const NearestTriangles::Hit& hit, const SurfaceSample& sample) {
        const Value value = value_of(sample.normal, sample.colour);
        const Vec3d weights = hit.weights.cast<double>();
        const auto area = static_cast<double>(sample.area);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = 3 * hit.triangle + k;
            shared_weight_[corner] += area * weights[k] * weights[(k + 1) % 3];
            const std::uint32_t vertex = own(level_.corners[corner]);
            if (vertex == kNone) continue;
            weight_[vertex] += area * weights[k] * weights[k];
            right_[vertex] += area * weights[k] * value;
        }
    }

    /// `share`: of the surface's samples that are used.
    void expect(std::uint32_t triangle, double area, double share) {
        for (std::uint32_t k = 0; k < 3; ++k)
            if (const std::uint32_t vertex = own(level_.corners[3 * triangle + k]); vertex != kNone)
                even_weight_[vertex] += share * area / 6;
    }

    template <typename Changes>
    void solve(const Changes& changes) {
        const std::vector<Value> before = solution_;
        for (int round = 0; round < kRounds; ++round)
            for (std::size_t vertex = 0; vertex < solution_.size(); ++vertex) {
                if (!(weight_[vertex] > 0) || !changes(vertex)) continue;
                const double hold = kHold * std::max(weight_[vertex], even_weight_[vertex]);
                Value sum = right_[vertex] + hold * before[vertex];
                for (const std::uint32_t corner : corners_of_.of(vertex)) {
                    const std::uint32_t next = next_in_triangle(corner), previous = next_in_triangle(next);
                    sum -= shared_weight_[corner] * value_at(level_.corners[next]) +
                           shared_weight_[previous] * value_at(level_.corners[previous]);
                }
                solution_[vertex] = sum / (weight_[vertex] + hold);
            }
    }

    const Value& at(std::size_t vertex) const { return solution_[vertex]; }

  private:
    std::uint32_t own(std::uint32_t index) const { return index < first_own_ ? kNone : index - first_own_; }
    Value value_at(std::uint32_t index) const {
        if (index >= first_own_) return solution_[index - first_own_];
        return value_of(normal_of(vertices_.vertices[index]), colour_of(vertices_.vertices[index]));
    }

    const RenderVertices& vertices_;
    const RegionTriangles& level_;
    std::uint32_t first_own_;
    Rows corners_of_;                  // of each own vertex
    std::vector<double> weight_;       // the diagonal
    std::vector<double> even_weight_;  // the same of samples that are spread evenly: a sixth of the area around
    std::vector<Value> right_, solution_;
    std::vector<double> shared_weight_;  // of each corner: its vertex with the next one's
};

}  // namespace

SurfaceSample sample_triangle(const IndexedMesh& mesh, const RenderVertices& vertices, std::uint32_t triangle) {
    const Triangle& corners = mesh.triangles[triangle];
    const Vec3f &a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]], &c = mesh.positions[corners[2]];
    Vec3f normal = Vec3f::Zero(), colour = Vec3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const format::Vertex& vertex = vertices.vertices[vertices.indices[std::size_t{3} * triangle + k]];
        normal += normal_of(vertex);
        colour += colour_of(vertex) / 3;
    }
    return {(a + b + c) / 3, normal.normalized(), colour, (b - a).cross(c - a).norm() / 2};
}

void fit_attributes(const IndexedMesh& mesh, const RenderVertices& vertices, std::span<const SurfaceSample> samples,
                    std::size_t most, std::span<const std::uint8_t> shared, RegionTriangles& level) {
    const auto first_own = static_cast<std::uint32_t>(vertices.vertices.size());
    std::vector<std::uint32_t> places;
    for (const std::uint32_t index : level.corners)
        places.push_back(index < first_own ? vertices.position[index] : level.position[index - first_own]);
    if (level.corners.empty()) return;
    const std::size_t step = std::max<std::size_t>(1, (samples.size() + most - 1) / most);
    const NearestTriangles nearest(mesh, std::move(places));
    const std::vector<NearestTriangles::Hit> hits = nearest.of(samples, step);
    LeastSquares fit(vertices, level);
    for (std::uint32_t triangle = 0; triangle < level.corners.size() / 3; ++triangle)
        fit.expect(triangle, nearest.area(triangle), 1 / static_cast<double>(step));
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i].triangle != kNone) fit.add(hits[i], samples[step * i]);
    fit.solve([&](std::size_t vertex) { return shared[level.position[vertex]] == 0; });
    for (std::size_t i = 0; i < level.vertices.size(); ++i) {
        if (shared[level.position[i]] != 0) continue;
        format::Vertex& vertex = level.vertices[i];
        const Vec3f normal = fit.at(i).head<3>().cast<float>(), colour = fit.at(i).tail<3>().cast<float>();
        if (!(normal.normalized().dot(normal_of(vertex)) > kLeastCosine)) continue;
        vertex.normal = encode_octahedral(normal.x(), normal.y(), normal.z());
        if (mesh.has_colours)
            vertex.colour =
                rgba8_from_linear({colour[0], colour[1], colour[2], static_cast<float>(vertex.colour >> 24) / 255});
    }
}

}  // namespace splice
