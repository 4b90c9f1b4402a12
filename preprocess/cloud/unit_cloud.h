// A point cloud made ready: in the unit box, without exact duplicates, in Morton order.
#pragma once

#include "preprocess/cloud/point_cloud.h"

namespace splice {

/// Points near in space are near in the arrays: what follows works through them in order. At least one point.
struct UnitCloud {
    std::vector<Vec3f> positions;        // unit-box units: longest side 1, centred at the origin
    std::vector<Vec3f> normals;          // empty or one a point; unit, or zero = missing
    std::vector<std::uint32_t> colours;  // empty or one a point
    // source = unit * source_scale + source_offset
    double source_scale = 1;
    Vec3d source_offset = Vec3d::Zero();
    std::uint64_t duplicate_points = 0;  // dropped: at the place of an earlier point of the file
};

/// Deterministic for any thread count. Precondition: at least one point. Throws Error from 2^32 - 1 points on.
UnitCloud make_unit_cloud(PointCloud cloud);

}  // namespace splice
