// What Dear ImGui is about to draw, beside what it drew before: whether it has to be drawn again. No device.
#pragma once

#include "engine/viewer/presenter.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

struct ImDrawCmd;
struct ImDrawData;
struct ImDrawList;

namespace splice {

class InterfaceContent {
  public:
    /// Takes what ImGui::Render() left. Another revision() from then on if it differs from the last time.
    void take();
    std::uint64_t revision() const { return revision_; }
    /// Whether all that was taken lies within these parts of the window, each draw in one of them.
    bool within(std::span<const PixelRect> parts) const;

  private:
    struct Bounds {
        float left, top, right, bottom;  // pixels
    };

    void add_bounds(const ImDrawList& list, const ImDrawCmd& command, const ImDrawData& data);
    template <typename Value>
    void append(const Value* values, std::size_t count);

    std::vector<std::byte> content_, last_;
    std::vector<Bounds> draws_;
    std::uint64_t revision_ = 0;
};

}  // namespace splice
