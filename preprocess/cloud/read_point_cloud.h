// Which files are point clouds, and how they are read.
#pragma once

#include "preprocess/cloud/point_cloud.h"
#include "preprocess/mesh/source_file.h"

namespace splice {

/// By content first, by the name's ending only where the content does not tell: LAS, PCD, PLY whose faces are none, and
/// lines of numbers. Does not throw: what is damaged is refused by the parser that it goes to.
bool is_point_cloud(const SourceFile& file);

/// Precondition: is_point_cloud(file). Throws InputError; also when no usable point is left.
PointCloud parse_point_cloud(const SourceFile& file);

}  // namespace splice
