// Clip lines of surfels: Zwicker, Raesaenen, Botsch, Dachsbacher and Pauly 2004, "Perspective accurate splatting",
// found here from the mesh instead of drawn by hand.
#include "preprocess/surfel/disk_clip.h"

#include "preprocess/mesh/edge_table.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/surface_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_set>

namespace splice {
namespace {

constexpr float kEdgeCosine = 0.94f;  // of 20 degrees: a sharper edge between two triangles ends the surface
constexpr float kSlack = 0.004f;      // radii: rounding of the stored position, radius and normal
constexpr float kWorthIt = 0.96f;     // radii: lines farther out are left away

using Support = std::array<float, kClipDirections>;  // how far something reaches each way, radii

const std::array<Vec2f, kClipDirections>& directions() {
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
    for (std::size_t k = 0; k < support.size(); ++k)
        support[k] = std::max(support[k], directions()[k].dot(point));
}

/// The disk's own coordinates, as the shaders see them.
struct DiskFrame {
    Vec3f centre, s, t, n;
    float radius;

    explicit DiskFrame(const CoverSite& site) : centre(site.position), radius(site.radius) {
        const auto stored = decode_octahedral(encode_octahedral(site.normal.x(), site.normal.y(), site.normal.z()));
        const TangentFrame frame = tangents_of(stored);
        n = {stored[0], stored[1], stored[2]};
        s = {frame.s[0], frame.s[1], frame.s[2]};
        t = {frame.t[0], frame.t[1], frame.t[2]};
    }
    Vec2f operator()(const Vec3f& point) const {
        const Vec3f d = point - centre;
        return Vec2f(d.dot(s), d.dot(t)) / radius;
    }
};

/// A convex polygon cut to the octagon around the unit disk (Sutherland and Hodgman 1974).
class CutPolygon {
  public:
    CutPolygon(const Vec2f& a, const Vec2f& b, const Vec2f& c) : size_(3) {
        points_[0] = a, points_[1] = b, points_[2] = c;
        for (std::size_t k = 0; k < kClipDirections && size_ > 0; k += kClipDirections / 8)
            cut(directions()[k]);
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

/// The surface under a disk that hangs together with its centre.
class Sheet {
  public:
    Sheet(const IndexedMesh& mesh, const SmoothNeighbours& neighbours) : mesh_(mesh), neighbours_(neighbours) {}

    /// Whether it ends under the disk, and then how far it reaches.
    std::optional<Support> end_of(const CoverSite& site) {
        const DiskFrame frame(site);
        triangles_.assign(1, site.triangle);
        seen_.clear();
        seen_.insert(site.triangle);
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

  private:
    const IndexedMesh& mesh_;
    const SmoothNeighbours& neighbours_;
    std::vector<std::uint32_t> triangles_;
    std::unordered_set<std::uint32_t> seen_;
    std::vector<std::array<Vec2f, 3>> corners_;
};

}  // namespace

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

std::vector<std::uint16_t> fit_disk_clips(const IndexedMesh& mesh, const SmoothNeighbours& neighbours,
                                          const CoverCells& cells, const std::vector<CoverSite>& sites,
                                          const std::vector<std::uint32_t>& owner) {
    std::vector<std::uint32_t> support_of(sites.size(), kNoSite);
    std::vector<Support> supports;
    std::vector<DiskFrame> frames;
    Sheet sheet(mesh, neighbours);
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (!(sites[s].radius > 0)) continue;
        const std::optional<Support> support = sheet.end_of(sites[s]);
        if (!support) continue;
        support_of[s] = static_cast<std::uint32_t>(supports.size());
        supports.push_back(*support);
        frames.emplace_back(sites[s]);
    }
    for (const CellChunk& chunk : cells.chunks) {
        CoverCells::for_each_cell(chunk, [&](std::uint32_t cell, const std::array<Vec3f, 4>& corners) {
            const std::uint32_t at = owner[cell] == kNoSite ? kNoSite : support_of[owner[cell]];
            if (at == kNoSite) return;
            for (const Vec3f& corner : corners)
                reach_to(supports[at], frames[at](corner));
        });
    }
    std::vector<std::uint16_t> clips(sites.size(), kNoClip);
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (support_of[s] == kNoSite) continue;
        const Support& reached = supports[support_of[s]];
        const auto least = std::min_element(reached.begin(), reached.end());
        if (*least + kSlack < kWorthIt)
            clips[s] = encode_clip(static_cast<int>(least - reached.begin()), *least + kSlack);
    }
    return clips;
}

}  // namespace splice
