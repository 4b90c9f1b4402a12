// What bounds the disks below a node of a point octree: their sphere, normal cone, ellipse and how far they leave the
// node's plane. Disks lie in arrays, one a component, four at a time for the processor's vectors.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/model_format.h"

#include <array>
#include <vector>

namespace splice {

class DiskArrays {
  public:
    static constexpr std::size_t kStep = 4;

    std::size_t size() const { return component_[0].size(); }
    void clear();
    /// `surfel` is unclipped or larger than what is left of it.
    void add(const format::Surfel& surfel);
    /// Repeats the last disk up to a multiple of kStep, which changes no bound.
    void fill_step();

    Vec3f normal(std::size_t disk) const { return {of(kNx)[disk], of(kNy)[disk], of(kNz)[disk]}; }
    float radius(std::size_t disk) const { return of(kRadius)[disk]; }

    enum Component { kX, kY, kZ, kNx, kNy, kNz, kRadius, kAbove, kBelow, kSphere, kComponents };
    const float* of(Component component) const { return component_[component].data(); }

  private:
    std::array<std::vector<float>, kComponents> component_;
};

/// Where a node is: its centre, and unit vectors across its plane and along the axes of its ellipse.
struct NodeFrame {
    Vec3f centre, normal, major, minor;
};

struct DiskBounds {
    float sphere = 0;            // radius about the centre that holds every disk, its solid included
    float cosine = 1;            // of the largest angle between a normal and the node's
    float above = 0, below = 0;  // how far disks leave the plane, at least 0
    float largest_radius = 0;    // of a disk
    float major = 0, minor = 0;  // half axes of an ellipse that holds the disks' projections
};

/// Of disks [begin, end), which are whole steps. In single precision: errors are within 4e-6 of the lengths.
DiskBounds bound_disks(const DiskArrays& disks, std::size_t begin, std::size_t end, const NodeFrame& frame);

}  // namespace splice
