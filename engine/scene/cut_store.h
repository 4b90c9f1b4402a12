// What the cuts of a frame chose, on the device: short runs of surfels and single ellipses are gathered into one buffer
// that is written anew each frame, so that no cut takes more than a few draws; long runs of surfels stay where they
// are.
#pragma once

#include "engine/scene/draw_list.h"
#include "engine/scene/surfel_store.h"

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

  private:
    gpu::Device& device_;
    std::optional<SurfelStore> store_;
};

}  // namespace splice
