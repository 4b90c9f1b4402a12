#include "preprocess/surfel/sheet.h"

#include "preprocess/mesh/edge_table.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/surface_point.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace splice {
namespace {

constexpr float kEdgeCosine = 0.94f;  // of 20 degrees: a sharper edge between two triangles ends the surface

/// A convex polygon cut to the octagon around the unit disk (Sutherland and Hodgman 1974).
class CutPolygon {
  public:
    CutPolygon(const Vec2f& a, const Vec2f& b, const Vec2f& c) : size_(3) {
        points_[0] = a, points_[1] = b, points_[2] = c;
        for (std::size_t k = 0; k < kClipDirections && size_ > 0; k += kClipDirections / 8)
            cut(clip_directions()[k]);
    }
    const Vec2f* begin() const { return points_.data(); }
    const Vec2f* end() const { return points_.data() + size_; }

  private:
    void cut(const Vec2f& direction) {
        std::array<Vec2f, 16> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const Vec2f &a = points_[i], &b = points_[(i + 1) % size_];
            const float da = direction.dot(a) - 1, db = direction.dot(b) - 1;
            if (da <= 0) kept[count++] = a;
            if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept[count++] = a + da / (da - db) * (b - a);
        }
        points_ = kept;
        size_ = count;
    }
    std::array<Vec2f, 16> points_;
    std::size_t size_;
};

bool segment_meets_disk(const Vec2f& a, const Vec2f& b) {
    const Vec2f ab = b - a;
    const float length2 = ab.squaredNorm();
    const float along = length2 > 0 ? std::clamp(-a.dot(ab) / length2, 0.0f, 1.0f) : 0.0f;
    return (a + along * ab).squaredNorm() < 1;
}

bool has_end(const std::array<std::uint32_t, 3>& neighbours) {
    return std::find(neighbours.begin(), neighbours.end(), kNoTriangle) != neighbours.end();
}

/// Around the middle of triangle `t`.
float width_at(const IndexedMesh& mesh, std::uint32_t t, Sheet& sheet, float reach) {
    const Triangle& v = mesh.triangles[t];
    const Vec3f middle = (mesh.positions[v[0]] + mesh.positions[v[1]] + mesh.positions[v[2]]) / 3;
    const std::optional<Support> support = sheet.end_of(t, DiskFrame(middle, face_normal(mesh, t), reach));
    if (!support) return 2 * reach;
    constexpr std::size_t kHalf = kClipDirections / 2;
    float narrowest = 2;
    for (std::size_t k = 0; k < kHalf; ++k)
        narrowest = std::min(narrowest, (*support)[k] + (*support)[k + kHalf]);
    return narrowest * reach;
}

}  // namespace

const std::array<Vec2f, kClipDirections>& clip_directions() {
    static const auto table = [] {
        std::array<Vec2f, kClipDirections> result;
        for (int k = 0; k < kClipDirections; ++k) {
            const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / kClipDirections;
            result[static_cast<std::size_t>(k)] = {std::cos(turn), std::sin(turn)};
        }
        return result;
    }();
    return table;
}

void reach_to(Support& support, const Vec2f& point) {
    const auto& directions = clip_directions();
    for (std::size_t k = 0; k < support.size(); ++k)
        support[k] = std::max(support[k], directions[k].dot(point));
}

DiskFrame::DiskFrame(const Vec3f& centre_, const Vec3f& normal, float radius_) : centre(centre_), radius(radius_) {
    const auto stored = decode_octahedral(encode_octahedral(normal.x(), normal.y(), normal.z()));
    const TangentFrame frame = tangents_of(stored);
    n = {stored[0], stored[1], stored[2]};
    s = {frame.s[0], frame.s[1], frame.s[2]};
    t = {frame.t[0], frame.t[1], frame.t[2]};
}

std::optional<Support> Sheet::end_of(std::uint32_t at, const DiskFrame& frame) {
    triangles_.assign(1, at);
    seen_.clear();
    seen_.insert(at);
    corners_.clear();
    bool ends = false;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& triangle = mesh_.triangles[triangles_[i]];
        const std::array<std::uint32_t, 3> neighbours = neighbours_[triangles_[i]];
        const std::array<Vec2f, 3> corner{frame(mesh_.positions[triangle[0]]), frame(mesh_.positions[triangle[1]]),
                                          frame(mesh_.positions[triangle[2]])};
        corners_.push_back(corner);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!segment_meets_disk(corner[k], corner[(k + 1) % 3])) continue;
            if (neighbours[k] == kNoTriangle) {
                ends = true;
            } else if (seen_.insert(neighbours[k]).second) {
                triangles_.push_back(neighbours[k]);
            }
        }
    }
    if (!ends) return std::nullopt;
    Support support{};
    for (const auto& [a, b, c] : corners_) {
        for (const Vec2f& point : CutPolygon(a, b, c))
            reach_to(support, point);
    }
    return support;
}

SmoothNeighbours find_smooth_neighbours(const IndexedMesh& mesh) {
    SmoothNeighbours neighbours(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
    const EdgeTable edges = build_edge_table(mesh.triangles, mesh.positions.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto edge = edges.edge(e);
        if (edge.size() != 2 || face_normal(mesh, edge[0] / 3).dot(face_normal(mesh, edge[1] / 3)) < kEdgeCosine)
            continue;
        neighbours[edge[0] / 3][edge[0] % 3] = edge[1] / 3;
        neighbours[edge[1] / 3][edge[1] % 3] = edge[0] / 3;
    }
    return neighbours;
}

std::vector<float> sheet_widths(const IndexedMesh& mesh, const SmoothNeighbours& neighbours, float reach) {
    std::vector<float> widths(mesh.triangles.size(), 2 * reach);
    tbb::enumerable_thread_specific<Sheet> sheets(mesh, neighbours);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(widths.size()), 1024),
                      [&](const auto& range) {
                          Sheet& sheet = sheets.local();
                          for (std::uint32_t t = range.begin(); t != range.end(); ++t)
                              if (has_end(neighbours[t])) widths[t] = width_at(mesh, t, sheet, reach);
                      });
    return widths;
}

}  // namespace splice
