// A hole-free cover of a patch by disks: sites spread over the surface, every cell given to the nearest site that may
// cover it (a discrete restricted Voronoi diagram), each disk as large as the cells it was given need.
#pragma once

#include "preprocess/surfel/cover_cells.h"

#include <cstdint>
#include <vector>

namespace splice {

struct CoverSite {
    Vec3f position;              // on the surface
    Vec3f normal;                // unit
    float spacing;               // wanted distance to the neighbours
    std::uint32_t triangle;      // of the mesh, holds the position
    float radius;                // of the disk
    float above = 0, below = 0;  // how far the owned cells leave the disk's plane; at most the radius
};

inline constexpr std::uint32_t kNoSite = 0xffffffffu;

/// A disk may cover a cell only if their normals agree (kLeastAgreement) and the cell's centre is at most this share of
/// the site's spacing off the disk's plane.
inline constexpr float kMostOffPlane = 0.25f;

/// Dart throwing on the cells' centres: no two sites of like normal nearer than 3/4 of the spacing, no room for
/// another.
std::vector<CoverSite> throw_darts(const IndexedMesh& mesh, const CoverCells& cells);

/// Moves sites to the middle of their Voronoi regions (Lloyd 1982), `iterations` times; sites stay on the surface.
void relax_sites(const IndexedMesh& mesh, const CoverCells& cells, std::vector<CoverSite>& sites, int iterations);

/// Removes sites that are not needed to cover every cell with disks of `reach` times the spacing, most redundant first.
void prune_sites(const CoverCells& cells, std::vector<CoverSite>& sites, float reach);

/// Gives every cell an owner, adding a site wherever no site may cover a cell, and sets every radius: what the owned
/// cells need, at least `overlap` times the square root of their area, at least `reach` times the spacing. Sites that
/// own nothing are removed unless `reach` is above 0. Returns the owner of each cell.
std::vector<std::uint32_t> close_cover(const IndexedMesh& mesh, const CoverCells& cells, std::vector<CoverSite>& sites,
                                       float overlap, float reach);

}  // namespace splice
