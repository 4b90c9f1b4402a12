// A point cloud's disks -> a Model of surfels only, in the order of their point octree, in patches of consecutive ones.
#pragma once

#include "preprocess/cloud/cloud_surface.h"
#include "preprocess/model_format/model.h"

namespace splice {

/// Points of a patch at most.
inline constexpr std::size_t kCloudPatchPoints = 1024;

/// Deterministic for any thread count.
Model assemble_cloud(const UnitCloud& cloud, const CloudSurface& surface);

}  // namespace splice
