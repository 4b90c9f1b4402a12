// A made-up airborne scan of any size, for measuring how point clouds bake.
#pragma once

#include <cstdint>
#include <filesystem>

namespace splice::bench {

/// Writes a LAS 1.2 file of point format 2 (coordinates to the millimetre, colours, no normals): scan lines over hills
/// with flat roofs and walls of points in tree crowns, four points a square metre. The same bytes for the same count.
/// Throws SystemError.
void write_scan_cloud(const std::filesystem::path& path, std::uint32_t points);

}  // namespace splice::bench
