// What a point cloud file says: points about a local origin, with colours and normals where the file has them.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace splice {

/// Coordinates are the file's: source = origin + offset. The origin is the first usable point, so that coordinates of
/// survey size (a UTM northing has seven digits before the point) keep what a float has: 0.03 mm in a scan of 1 km.
struct PointCloud {
    Vec3d origin = Vec3d::Zero();
    std::vector<Vec3f> offsets;
    std::vector<Vec3f> normals;          // empty or one a point; not unit; zero vector = missing
    std::vector<std::uint32_t> colours;  // empty or one a point; sRGB RGBA8, R in the lowest byte

    std::uint64_t source_points = 0;     // as the file has them
    std::uint64_t nonfinite_points = 0;  // dropped: a coordinate is no number, or too far from the origin for a float
    std::uint64_t withheld_points = 0;   // dropped: LAS marks them as deleted
    std::vector<std::string> warnings;
};

}  // namespace splice
