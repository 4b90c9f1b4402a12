// Interpolation of what a triangle's corners carry, and the normal a surfel may have.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>

namespace splice {

/// Unit normal of a triangle, on the side of its corner normals; their mean's direction when the triangle has no area.
Vec3f face_normal(const IndexedMesh& mesh, std::uint32_t triangle);

/// Barycentric coordinates of the triangle's point nearest to `point` in its plane, clamped into the triangle; the
/// third of each corner when the triangle has no area.
Vec3f barycentric(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& point);

/// The point at barycentric coordinates.
Vec3f point_at(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric);

/// The normal of a disk's plane at that point: the face's where the triangle is as large as the `spacing` of the disks,
/// so that disks on a flat face lie in it and cover it seen from anywhere; surfel_normal() where it is much smaller.
Vec3f plane_normal(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric, const Vec3f& face_normal,
                   float spacing);

/// Interpolated corner normals, bent towards `face_normal` until they agree to within 45 degrees: a disk that leans
/// more would not represent the surface it stands for. Unit.
Vec3f surfel_normal(const IndexedMesh& mesh, std::uint32_t triangle, const Vec3f& barycentric,
                    const Vec3f& face_normal);

}  // namespace splice
