// The parsers behind parse_point_cloud: bytes in memory -> PointCloud. None trusts a count or an offset; what cannot be
// read throws InputError with `name` and a line or byte offset. Points without finite coordinates are dropped and
// counted.
#pragma once

#include "preprocess/cloud/point_cloud.h"

#include <string>
#include <string_view>

namespace splice {

/// PLY (Turk 1994) for its vertices alone: positions, normals, colours; ascii and both binary orders.
PointCloud parse_ply_cloud(std::string_view bytes, const std::string& name);

/// One point a line, numbers separated by blanks, commas or semicolons: XYZ, PTS, PWN, TXT, ASC, CSV. The first three
/// are the position; of the rest, unit vectors are normals and whole numbers of 0..255 colours, the same in all lines.
/// Heading lines, comments (# or //) and lines with a count are skipped. `extension` with its dot, in lower case.
PointCloud parse_text_cloud(std::string_view bytes, const std::string& extension, const std::string& name);

/// PCD 0.5 to 0.7 of the Point Cloud Library: ascii, binary, binary_compressed.
PointCloud parse_pcd(std::string_view bytes, const std::string& name);

/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10, not compressed. Points marked as withheld are dropped and counted.
PointCloud parse_las(std::string_view bytes, const std::string& name);

}  // namespace splice
