// The two real resources behind each history of a frame: in turns what the last frame left, and what this one makes.
#pragma once

#include "engine/render_graph/executor/pass_context.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

class Histories {
  public:
    /// `previous`: the resource that is the previous half. Both were created with TRANSFER_DST usage.
    void add(uint32_t previous, const BoundResource& a, const BoundResource& b) {
        pairs_.push_back({previous, {a, b}});
    }
    bool empty() const { return pairs_.empty(); }
    /// 0 or 1: which of the two is the previous half in the frame begun last.
    uint32_t side() const { return side_; }

    /// Swaps the halves for a new frame.
    void begin_frame(std::span<BoundResource> bound);
    /// Records that the previous halves take their initial contents, whatever used them before.
    void reset(VkCommandBuffer commands, const Graph& graph, const Plan& plan) const;

  private:
    struct Pair {
        uint32_t previous;
        BoundResource sides[2];
    };
    std::vector<Pair> pairs_;
    uint32_t side_ = 0;
};

}  // namespace splice::graph
