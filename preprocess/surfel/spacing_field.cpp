// Curvature-adaptive spacing as in ALGORITHMS section 1; Lipschitz grading as in mesh sizing fields (Persson 2006).
#include "preprocess/surfel/spacing_field.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace splice {
namespace {

constexpr float kTurnPerSpacing = 0.5f;      // radians, at most
constexpr float kColourPerSpacing = 0.12f;   // of the distance from black to one primary, sRGB-encoded, at most
constexpr float kFinestDetail = 1.0f / 512;  // no curvature or colour asks for less: a pixel of a small picture
constexpr float kMostTextureSteps = 64;      // along the longest edge of a triangle
// Disks are cut at edges, but by one line only, so corners overhang: hence a spacing at creases. Where the surface is
// narrower than such a disk, as slivers at a folded rim are, spacing follows its width: on its other side the disk
// would stand out.
constexpr float kNarrowest = 1.0f / 1000;
constexpr float kCreaseCosine = 0.94f;  // corner normals that differ by more than 20 degrees across an edge
constexpr int kMaxGradingSweeps = 24;

struct HalfEdge {
    std::uint32_t other;   // the edge's vertex of higher index
    std::uint32_t corner;  // 3 t + k: the edge runs from corner k to k + 1 of triangle t
};

std::uint32_t next_corner(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

Vec3f colour_vector(std::uint32_t rgba) {
    return Vec3f(static_cast<float>(rgba & 0xffu), static_cast<float>((rgba >> 8) & 0xffu),
                 static_cast<float>((rgba >> 16) & 0xffu)) /
           255.0f;
}

// Squared Frobenius norm of the gradient of a linear function on a triangle with edges e1, e2 from one corner along
// which the function changes by d1, d2.
float squared_gradient(const Vec3f& e1, const Vec3f& e2, const Vec3f& d1, const Vec3f& d2, float squared_double_area) {
    const float g =
        d1.squaredNorm() * e2.squaredNorm() - 2 * d1.dot(d2) * e1.dot(e2) + d2.squaredNorm() * e1.squaredNorm();
    return std::max(g, 0.0f) / squared_double_area;
}

// The same of an image's colours, in the mean over the triangle: looked at on a lattice of steps of two of the finest
// details.
float squared_texture_gradient(const SurfaceColour& colour, std::uint32_t t, const Vec3f& e1, const Vec3f& e2,
                               float squared_double_area) {
    const float longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
    const auto steps = static_cast<int>(std::clamp(std::ceil(longest / (2 * kFinestDetail)), 1.0f, kMostTextureSteps));
    const float step = 1 / static_cast<float>(steps);
    const auto sample = [&](int i, int j) {
        const float u = step * static_cast<float>(i), v = step * static_cast<float>(j);
        return colour_vector(SurfaceColour::encode(colour.at(t, {1 - u - v, u, v}, kFinestDetail)));
    };
    std::vector<Vec3f> row(static_cast<std::size_t>(steps) + 1), next(row.size());
    for (int i = 0; i <= steps; ++i)
        next[static_cast<std::size_t>(i)] = sample(i, 0);
    const float part = step * step;
    float sum = 0;
    for (int j = 0; j < steps; ++j) {
        std::swap(row, next);
        for (int i = 0; i < steps - j; ++i)
            next[static_cast<std::size_t>(i)] = sample(i, j + 1);
        for (int i = 0; i < steps - j; ++i) {
            const auto k = static_cast<std::size_t>(i);
            sum += squared_gradient(step * e1, step * e2, row[k + 1] - row[k], next[k] - row[k],
                                    part * part * squared_double_area);
        }
    }
    return sum / static_cast<float>(steps * (steps + 1) / 2);
}

float distance_to_segment(const Vec3f& p, const Vec3f& a, const Vec3f& b) {
    const Vec3f ab = b - a;
    const float length2 = ab.squaredNorm();
    const float s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0f, 1.0f) : 0.0f;
    return (a + s * ab - p).norm();
}

}  // namespace

SpacingField::SpacingField(const IndexedMesh& mesh, const SmoothNeighbours& neighbours, const SurfaceColour& colour,
                           const SamplingOptions& options)
    : mesh_(mesh),
      feature_spacing_(std::clamp(static_cast<float>(options.crease_spacing), static_cast<float>(options.h_min),
                                  static_cast<float>(options.h_max))) {
    measure_detail(colour, options);
    grade(vertex_spacing_);
    find_features();
    grade(feature_distance_);
    width_ = sheet_widths(mesh, neighbours, feature_spacing_ / 2);
    const float narrowest = std::min(std::max(kNarrowest, static_cast<float>(options.h_min)), feature_spacing_);
    for (float& width : width_)
        width = width < feature_spacing_ ? std::max(width, narrowest) : std::numeric_limits<float>::max();
}

void SpacingField::measure_detail(const SurfaceColour& colour, const SamplingOptions& options) {
    const std::size_t vertex_count = mesh_.positions.size();
    std::vector<float> turn(vertex_count, 0.0f), change(vertex_count, 0.0f), area(vertex_count, 0.0f);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const auto& v = mesh_.triangles[t];
        const Vec3f e1 = mesh_.positions[v[1]] - mesh_.positions[v[0]],
                    e2 = mesh_.positions[v[2]] - mesh_.positions[v[0]];
        const float squared_double_area = e1.cross(e2).squaredNorm();
        if (!(squared_double_area > 0)) continue;
        const float w = std::sqrt(squared_double_area);
        const Vec3f* n = &mesh_.corner_normals[3 * t];
        const float turn2 = squared_gradient(e1, e2, n[1] - n[0], n[2] - n[0], squared_double_area);
        float change2 = 0;
        if (colour.textured(static_cast<std::uint32_t>(t))) {
            change2 = squared_texture_gradient(colour, static_cast<std::uint32_t>(t), e1, e2, squared_double_area);
        } else if (!mesh_.corner_colours.empty()) {
            const std::uint32_t* c = &mesh_.corner_colours[3 * t];
            const Vec3f c0 = colour_vector(c[0]);
            change2 = squared_gradient(e1, e2, colour_vector(c[1]) - c0, colour_vector(c[2]) - c0, squared_double_area);
        }
        for (const auto i : v) {
            area[i] += w;
            turn[i] += w * turn2;
            change[i] += w * change2;
        }
    }
    const auto h_min = static_cast<float>(options.h_min), h_max = static_cast<float>(options.h_max);
    // The blend of surfels misses a shading gradient g by about 0.07 g s at spacing s. With n surfels to spend, the
    // squared error summed over the surface is least for s ~ g^(-1/2), that is at a constant sagitta s^2 curvature / 8.
    const auto sagitta = static_cast<float>(options.sagitta);
    vertex_spacing_.resize(vertex_count);
    for (std::size_t i = 0; i < vertex_count; ++i) {
        float spacing = h_max;
        if (area[i] > 0) {
            const float curvature = std::sqrt(turn[i] / area[i]), gradient = std::sqrt(change[i] / area[i]);
            if (curvature > 0) {
                spacing = std::min({spacing, kTurnPerSpacing / curvature, std::sqrt(8 * sagitta / curvature)});
            }
            if (gradient > 0) spacing = std::min(spacing, kColourPerSpacing / gradient);
            spacing = std::max(spacing, kFinestDetail);
        }
        vertex_spacing_[i] = std::clamp(spacing, h_min, h_max);
    }
}

void SpacingField::find_features() {
    const std::size_t vertex_count = mesh_.positions.size(), corner_count = 3 * mesh_.triangles.size();
    const auto vertex_of = [&](std::uint32_t corner) { return mesh_.triangles[corner / 3][corner % 3]; };

    // Half-edges in buckets by their lower vertex.
    std::vector<std::uint32_t> begin(vertex_count + 1, 0);
    for (std::uint32_t c = 0; c < corner_count; ++c)
        ++begin[std::min(vertex_of(c), vertex_of(next_corner(c))) + 1];
    for (std::size_t i = 0; i < vertex_count; ++i)
        begin[i + 1] += begin[i];
    std::vector<HalfEdge> half_edges(corner_count);
    {
        std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
        for (std::uint32_t c = 0; c < corner_count; ++c) {
            const auto a = vertex_of(c), b = vertex_of(next_corner(c));
            half_edges[fill[std::min(a, b)]++] = {std::max(a, b), c};
        }
    }

    const auto is_feature = [&](std::span<const HalfEdge> edge) {
        if (edge.size() != 2) return true;
        const auto c = edge[0].corner, d = edge[1].corner;
        const bool opposite = vertex_of(c) != vertex_of(d);
        const auto d_of_c_start = opposite ? next_corner(d) : d, d_of_c_end = opposite ? d : next_corner(d);
        const auto& n = mesh_.corner_normals;
        return n[c].dot(n[d_of_c_start]) < kCreaseCosine || n[next_corner(c)].dot(n[d_of_c_end]) < kCreaseCosine;
    };
    std::vector<std::uint8_t> corner_feature(corner_count, 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertex_count, 4096), [&](const auto& range) {
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
            const auto first = half_edges.begin() + begin[v], last = half_edges.begin() + begin[v + 1];
            std::sort(first, last, [](const HalfEdge& a, const HalfEdge& b) {
                return a.other != b.other ? a.other < b.other : a.corner < b.corner;
            });
            for (auto i = first; i != last;) {
                const auto j = std::find_if(i, last, [&](const HalfEdge& e) { return e.other != i->other; });
                if (is_feature({i, j})) {
                    for (auto k = i; k != j; ++k)
                        corner_feature[k->corner] = 1;
                }
                i = j;
            }
        }
    });

    feature_edge_.assign(mesh_.triangles.size(), 0);
    feature_distance_.assign(vertex_count, std::numeric_limits<float>::max());
    for (std::uint32_t c = 0; c < corner_count; ++c) {
        if (corner_feature[c] == 0) continue;
        feature_edge_[c / 3] = static_cast<std::uint8_t>(feature_edge_[c / 3] | (1u << (c % 3)));
        feature_distance_[vertex_of(c)] = feature_distance_[vertex_of(next_corner(c))] = feature_spacing_;
    }
}

void SpacingField::grade(std::vector<float>& values) const {
    // Gauss-Seidel sweeps to and fro over the triangles; a handful suffices as limits act over short distances only.
    const auto relax = [&](const Triangle& v) {
        bool changed = false;
        for (int k = 0; k < 3; ++k) {
            const auto a = v[static_cast<std::size_t>(k)], b = v[static_cast<std::size_t>((k + 1) % 3)];
            if (values[a] == values[b]) continue;
            const float reach = kGrading * (mesh_.positions[a] - mesh_.positions[b]).norm();
            if (values[a] > values[b] + reach) {
                values[a] = values[b] + reach;
                changed = true;
            } else if (values[b] > values[a] + reach) {
                values[b] = values[a] + reach;
                changed = true;
            }
        }
        return changed;
    };
    const auto& triangles = mesh_.triangles;
    for (int sweep = 0; sweep < kMaxGradingSweeps; ++sweep) {
        bool changed = false;
        if (sweep % 2 == 0) {
            for (auto t = triangles.begin(); t != triangles.end(); ++t)
                changed |= relax(*t);
        } else {
            for (auto t = triangles.rbegin(); t != triangles.rend(); ++t)
                changed |= relax(*t);
        }
        if (!changed) break;
    }
}

float SpacingField::at(std::uint32_t t, const Vec3f& point) const {
    const auto& v = mesh_.triangles[t];
    const std::array<Vec3f, 3> p = {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    const Vec3f n = (p[1] - p[0]).cross(p[2] - p[0]);
    const float squared_double_area = n.squaredNorm();
    float b1 = 0, b2 = 0;
    if (squared_double_area > 0) {
        b1 = std::clamp((point - p[0]).cross(p[2] - p[0]).dot(n) / squared_double_area, 0.0f, 1.0f);
        b2 = std::clamp((p[1] - p[0]).cross(point - p[0]).dot(n) / squared_double_area, 0.0f, 1.0f - b1);
    }
    float spacing = (1 - b1 - b2) * vertex_spacing_[v[0]] + b1 * vertex_spacing_[v[1]] + b2 * vertex_spacing_[v[2]];
    for (std::size_t k = 0; k < 3; ++k) {
        if (feature_distance_[v[k]] < spacing) {
            spacing = std::min(spacing, feature_distance_[v[k]] + kGrading * (point - p[k]).norm());
        }
        if ((feature_edge_[t] >> k & 1u) != 0) {
            spacing = std::min(spacing, feature_spacing_ + kGrading * distance_to_segment(point, p[k], p[(k + 1) % 3]));
        }
    }
    return std::min(spacing, width_[t]);
}

}  // namespace splice
