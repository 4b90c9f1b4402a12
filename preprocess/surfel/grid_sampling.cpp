// The three grids are orthographic rasterisations: each triangle is scan-converted instead of casting each ray.
#include "preprocess/surfel/grid_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splice {
namespace {

void scan_convert(const IndexedMesh& mesh, std::uint32_t triangle, double h, std::vector<GridSample>& samples) {
    std::array<Vec3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = mesh.positions[mesh.triangles[triangle][k]].cast<double>();
    const Vec3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    if (!(std::abs(normal[axis]) > 0)) return;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::sort(p.begin(), p.end(), [&](const Vec3d& a, const Vec3d& b) { return a[v] < b[v]; });

    // Half-open in both directions, so that a line through a shared edge hits one of its triangles.
    const auto u_at = [&](const Vec3d& a, const Vec3d& b, double at) {
        return a[u] + (b[u] - a[u]) * (at - a[v]) / (b[v] - a[v]);
    };
    for (double row = std::ceil(p[0][v] / h); row * h < p[2][v]; ++row) {
        const double at = row * h;
        const double u_long = u_at(p[0], p[2], at);
        const double u_short = at < p[1][v] ? u_at(p[0], p[1], at) : u_at(p[1], p[2], at);
        const double low = std::min(u_long, u_short), high = std::max(u_long, u_short);
        for (double column = std::ceil(low / h); column * h < high; ++column) {
            Vec3d hit;
            hit[u] = column * h;
            hit[v] = at;
            hit[axis] = p[0][axis] - (normal[u] * (hit[u] - p[0][u]) + normal[v] * (hit[v] - p[0][v])) / normal[axis];
            samples.push_back({hit.cast<float>(), triangle});
        }
    }
}

struct PatchEdge {
    std::uint32_t low, high, triangle;
};

void sample_border(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, float h,
                   std::vector<GridSample>& samples) {
    std::vector<PatchEdge> edges;
    edges.reserve(3 * triangles.size());
    for (const auto t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), t});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const PatchEdge& a, const PatchEdge& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    std::vector<PatchEdge> corners;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i + 1;
        while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high)
            ++j;
        if (j - i != 2) {
            const PatchEdge& e = edges[i];
            const Vec3f a = mesh.positions[e.low], b = mesh.positions[e.high];
            const auto steps = std::max(1.0f, std::ceil((b - a).norm() / h));
            for (float step = 1; step < steps; ++step)
                samples.push_back({a + step / steps * (b - a), e.triangle});
            corners.push_back({e.low, 0, e.triangle});
            corners.push_back({e.high, 0, e.triangle});
        }
        i = j;
    }
    std::sort(corners.begin(), corners.end(), [](const PatchEdge& a, const PatchEdge& b) {
        return a.low != b.low ? a.low < b.low : a.triangle < b.triangle;
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i == 0 || corners[i].low != corners[i - 1].low)
            samples.push_back({mesh.positions[corners[i].low], corners[i].triangle});
    }
}

}  // namespace

float thesis_spacing(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, double c, double h_min,
                     double h_max) {
    double sum = 0;
    for (const auto t : triangles) {
        const auto& v = mesh.triangles[t];
        for (std::size_t k = 0; k < 3; ++k)
            sum += (mesh.positions[v[k]] - mesh.positions[v[(k + 1) % 3]]).norm();
    }
    const double edges = 3 * static_cast<double>(std::max<std::size_t>(1, triangles.size()));
    return static_cast<float>(std::clamp(sum / edges / c, h_min, h_max));
}

std::vector<GridSample> sample_on_grids(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, float h) {
    std::vector<GridSample> samples;
    for (const auto t : triangles)
        scan_convert(mesh, t, static_cast<double>(h), samples);
    sample_border(mesh, triangles, h, samples);
    return samples;
}

}  // namespace splice
