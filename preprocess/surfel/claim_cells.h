// The innermost loops of covering a patch: which cells of a range a site's disk may cover, in vectors as wide as the
// processor has, with the same results for every width.
#pragma once

#include "preprocess/surfel/voronoi_cover.h"
#include "preprocess/vector_width.h"

#include <cstdint>

namespace splice {

/// What decides whether a site's disk may cover a cell, apart from their normals.
struct SiteReach {
    float x, y, z, nx, ny, nz, limit2, off_plane;

    SiteReach(const CoverSite& site, float distance)
        : x(site.position.x()),
          y(site.position.y()),
          z(site.position.z()),
          nx(site.normal.x()),
          ny(site.normal.y()),
          nz(site.normal.z()),
          limit2(distance * distance),
          off_plane(kMostOffPlane * site.spacing) {}

    bool covers(float px, float py, float pz, float& distance2) const {
        const float dx = px - x, dy = py - y, dz = pz - z;
        const float plane = dx * nx + dy * ny + dz * nz;
        distance2 = dx * dx + dy * dy + dz * dz;
        return (distance2 <= limit2) & ((plane < 0 ? -plane : plane) <= off_plane);
    }
};

/// Centres of cells in a row.
struct CellRange {
    const float *x, *y, *z;
    std::uint32_t count;
};

/// Cells that the site reaches and that are nearer to it than to their owner change hands; distances are squared and
/// times `scale`.
void claim_cells(const SiteReach& reach, float scale, std::uint32_t site, const CellRange& cells, float* nearest,
                 std::uint32_t* owner, VectorWidth widest = VectorWidth::k256);

/// Sets the marks of the cells that the site reaches to 1.
void mark_cells(const SiteReach& reach, const CellRange& cells, std::uint32_t* marks,
                VectorWidth widest = VectorWidth::k256);

}  // namespace splice
