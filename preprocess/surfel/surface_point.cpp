// Closest point on a triangle after Ericson 2005, Real-Time Collision Detection, 5.1.5.
#include "preprocess/surfel/surface_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace splice {

Vec3f face_normal(const IndexedMesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle];
    const Vec3f* n = &mesh.corner_normals[3 * std::size_t{triangle}];
    const Vec3f smooth = n[0] + n[1] + n[2];
    Vec3f normal = (mesh.positions[v[1]] - mesh.positions[v[0]])
                       .cross(mesh.positions[v[2]] - mesh.positions[v[0]])
                       .stableNormalized();
    if (!(normal.squaredNorm() > 0.5f)) normal = smooth.stableNormalized();
    if (!(normal.squaredNorm() > 0.5f)) normal = n[0];
    return normal.dot(smooth) < 0 ? Vec3f(-normal) : normal;
}

Vec3f barycentric(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& point) {
    const auto& v = mesh.triangles[triangle];
    // In double: slivers leave no digits of a float.
    const Vec3d a = mesh.positions[v[0]].cast<double>(), b = mesh.positions[v[1]].cast<double>(),
                c = mesh.positions[v[2]].cast<double>(), p = point.cast<double>();
    const Vec3d ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3d bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double s = d1 > d3 ? d1 / (d1 - d3) : 0;
        return Vec3d(1 - s, s, 0).cast<float>();
    }
    const Vec3d cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double s = d2 > d6 ? d2 / (d2 - d6) : 0;
        return Vec3d(1 - s, 0, s).cast<float>();
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double length = (d4 - d3) + (d5 - d6);
        const double s = length > 0 ? (d4 - d3) / length : 0;
        return Vec3d(0, 1 - s, s).cast<float>();
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return Vec3f::Constant(1.0f / 3);
    const double s = vb / sum, t = vc / sum;
    return Vec3d(1 - s - t, s, t).cast<float>();
}

Vec3f point_at(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric) {
    const auto& v = mesh.triangles[triangle];
    return barycentric[0] * mesh.positions[v[0]] + barycentric[1] * mesh.positions[v[1]] +
           barycentric[2] * mesh.positions[v[2]];
}

Vec3f surfel_normal(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric,
                    const Vec3f& face_normal) {
    constexpr float kLeastCosine = 0.70710678f;
    const Vec3f* n = &mesh.corner_normals[3 * std::size_t{triangle}];
    const Vec3f sum = barycentric[0] * n[0] + barycentric[1] * n[1] + barycentric[2] * n[2];
    const float length = sum.norm();
    if (!(length > 1e-6f)) return face_normal;
    const Vec3f smooth = sum / length;
    const float cosine = smooth.dot(face_normal);
    if (cosine >= kLeastCosine) return smooth;
    const Vec3f sideways = smooth - cosine * face_normal;
    const float sine = sideways.norm();
    if (!(sine > 1e-6f)) return face_normal;
    return (kLeastCosine * face_normal + std::sqrt(1 - kLeastCosine * kLeastCosine) / sine * sideways).normalized();
}

Vec3f plane_normal(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric, const Vec3f& face_normal,
                   float spacing) {
    constexpr float kSmall = 0.5f;  // of the spacing: triangles of that side no longer decide a disk's plane
    const auto& v = mesh.triangles[triangle];
    const Vec3f doubled =
        (mesh.positions[v[1]] - mesh.positions[v[0]]).cross(mesh.positions[v[2]] - mesh.positions[v[0]]);
    const float side = std::sqrt(0.5f * doubled.norm());
    const float share = std::clamp((side / spacing - kSmall) / (2 - kSmall), 0.0f, 1.0f);
    const Vec3f smooth = surfel_normal(mesh, triangle, barycentric, face_normal);
    return (share * face_normal + (1 - share) * smooth).normalized();
}

}  // namespace splice
