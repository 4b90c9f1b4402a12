// What the cuts of a frame chose, on the device: short runs of surfels and single ellipses are gathered into one buffer
// that is written anew each frame, so that no cut takes more than a few draws; long runs of surfels stay where they
// are. So are the triangles of patches at their levels, where the host sees the device's memory: there a draw costs as
// much as some hundred triangles.
#pragma once

#include "engine/scene/draw_list.h"
#include "engine/scene/surfel_store.h"
#include "engine/vulkan/buffer.h"

#include <optional>

namespace splice {

class CutStore {
  public:
    /// The device must outlive the store.
    explicit CutStore(gpu::Device& device) : device_(device) {}

    /// Makes ranges of the cuts of all instances. They are of this store, and hold until the next call. With
    /// `levels`, ellipses name their level in the tree, counted from 1, instead of their patch. No submitted work may
    /// still use the frame before.
    void gather(DrawList& draws, bool levels);

    /// Makes one range for each material of those instances that have many. Only where draws need not tell patches
    /// apart. As above.
    void gather_triangles(DrawList& draws);

    /// Of surfels, on the device.
    std::uint64_t bytes() const { return store_ ? store_->buffer().size() : 0; }

  private:
    gpu::Device& device_;
    std::optional<SurfelStore> store_;
    gpu::Buffer indices_;
};

}  // namespace splice
