// What the point cloud targets have in common: whatever the bytes, the parser delivers what point_cloud.h promises or
// throws a splice::Error.
#pragma once

#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/model_format/error.h"
#include "tests/fuzz/fuzz_check.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace splice::fuzz {

inline void check_cloud(const PointCloud& cloud) {
    const std::size_t points = cloud.offsets.size();
    require(cloud.normals.empty() || cloud.normals.size() == points, "normals are absent or complete");
    require(cloud.colours.empty() || cloud.colours.size() == points, "colours are absent or complete");
    require(points + cloud.nonfinite_points + cloud.withheld_points == cloud.source_points,
            "every point is kept or counted");
    require(cloud.origin.allFinite(), "the origin is finite");
    for (const Vec3f& offset : cloud.offsets)
        require(offset.allFinite(), "coordinates are finite");
    for (const Vec3f& normal : cloud.normals)
        require(normal.allFinite(), "normals are finite");
}

/// `parse` makes a PointCloud from a std::string_view.
template <class Parse>
int run_cloud(const std::uint8_t* data, std::size_t size, Parse parse) {
    try {
        check_cloud(parse(std::string_view(reinterpret_cast<const char*>(data), size)));
    } catch (const Error&) {
        return 0;
    }
    return 0;
}

}  // namespace splice::fuzz
