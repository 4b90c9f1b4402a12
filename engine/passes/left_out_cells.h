// Pipelines of the tile backend take long to make, and hardly any frame has cells so full that they are gathered in
// segments (TileCells). So a frame leaves them out as long as their pipelines are not made, and has the device count
// them: if there are any, the pipelines are made, and the frame is drawn again.
#pragma once

#include "engine/passes/splat_buffers.h"
#include "engine/passes/splat_programs.h"

#include <array>

namespace splice {

/// What gathers segments.
std::array<SplatPrograms::Program, 2> segment_programs(const SplatPrograms::Variant& variant);

class LeftOutCells {
  public:
    LeftOutCells(gpu::Device& device, SplatPrograms& programs);

    /// Of a frame whose cells may be gathered in segments: whether it leaves those out. If so, has them counted; the
    /// cell buffer must be complete.
    bool begin(graph::Graph& graph, graph::Bindings& bindings, graph::BufferHandle cells, const FrameSettings& settings,
               const SplatPrograms::Variant& variant);
    /// Of a frame that leaves nothing out.
    void begin_whole() { left_out_ = false; }

    /// After the frame was executed: whether it lacks cells, the pipelines for which are made now.
    bool make_lacking();

  private:
    SplatPrograms& programs_;
    gpu::Buffer counts_;  // the head of the cell buffer, as the frame left it
    FrameSettings settings_;
    SplatPrograms::Variant variant_;
    bool left_out_ = false;
};

}  // namespace splice
