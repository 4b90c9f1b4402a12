#include "engine/scene/triangle_bounds.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace splice {

namespace {

SurfelBounds bound(const ModelView& model, std::span<const std::uint32_t> indices) {
    const auto position = [&](std::size_t corner) {
        const float(&p)[3] = model.vertices[indices[corner]].position;
        return glm::dvec3(p[0], p[1], p[2]);
    };
    const auto cross = [&](std::size_t corner) {
        const glm::dvec3 origin = position(corner);
        return glm::cross(position(corner + 1) - origin, position(corner + 2) - origin);
    };
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low), normals(0);
    for (std::size_t corner = 0; corner < indices.size(); ++corner) {
        low = glm::min(low, position(corner));
        high = glm::max(high, position(corner));
        if (corner % 3 == 0) normals += cross(corner);
    }
    SurfelBounds bounds;
    if (!std::isfinite(glm::dot(low, high))) {
        bounds.radius = std::numeric_limits<float>::infinity();
        return bounds;
    }
    bounds.centre = glm::vec3(0.5 * (low + high));
    if (glm::length(normals) > 0) bounds.axis = glm::vec3(glm::normalize(normals));
    double radius = 0, cosine = 1;
    for (std::size_t corner = 0; corner < indices.size(); ++corner) {
        radius = std::max(radius, glm::distance(position(corner), glm::dvec3(bounds.centre)));
        if (corner % 3 != 0) continue;
        const glm::dvec3 normal = cross(corner);
        // What has no area is never drawn.
        if (const double length = glm::length(normal); length > 0)
            cosine = std::min(cosine, glm::dot(normal, glm::dvec3(bounds.axis)) / length);
    }
    bounds.radius = std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
    bounds.spread_cosine = static_cast<float>(std::max(cosine, -1.0));
    bounds.spread_sine = static_cast<float>(std::sqrt(std::max(1 - cosine * cosine, 0.0)));
    return bounds;
}

}  // namespace

TriangleBounds::TriangleBounds(const ModelView& model) {
    constexpr std::size_t kIndices = std::size_t{3} * kBoundedTriangles;
    std::vector<std::size_t> runs(model.lods.size(), 0);
    for (const format::OctreeNode& node : model.octree)
        for (std::uint32_t level = node.first_lod; level < node.first_lod + node.lod_count; ++level)
            runs[level] = (model.lods[level].index_count + kIndices - 1) / kIndices;
    first_run_.push_back(0);
    for (const std::size_t count : runs)
        first_run_.push_back(first_run_.back() + count);
    runs_.resize(first_run_.back());
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t level) {
        const format::Lod& lod = model.lods[level];
        tbb::parallel_for(std::size_t{0}, runs[level], [&](std::size_t run) {
            const std::size_t first = run * kIndices;
            runs_[first_run_[level] + run] =
                bound(model, model.indices.subspan(lod.first_index + first,
                                                   std::min<std::size_t>(kIndices, lod.index_count - first)));
        });
    });
}

}  // namespace splice
