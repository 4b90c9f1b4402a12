// Normals and colours of simplified triangles in least squares: values at the vertices that, linear in between, differ
// least from those of the surface that the triangles stand for. A vertex's own quadric (Hoppe 1999) has what suits the
// vertex. Where a field curves, such values leave linear pieces off to one side: by six times the least mean square, if
// they are the field's own.
#pragma once

#include "preprocess/simplify/region_simplifier.h"

#include <span>

namespace splice {

/// Of the surface as it was, in unit-box units.
struct SurfaceSample {
    Vec3f position, normal, colour;  // unit; linear, 0 to 1
    float area;
};

/// At the centroid of one of the mesh's triangles.
SurfaceSample sample_triangle(const IndexedMesh& mesh, const RenderVertices& vertices, std::uint32_t triangle);

/// Changes vertices of `level` that are not `shared` (RegionSimplifier). Of the samples, every so many are used so that
/// there are no more than `most`, at least 1. The same for any number of threads.
void fit_attributes(const IndexedMesh& mesh, const RenderVertices& vertices, std::span<const SurfaceSample> samples,
                    std::size_t most, std::span<const std::uint8_t> shared, RegionTriangles& level);

}  // namespace splice
