#include "engine/viewer/interface_content.h"

#include <imgui.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace splice {

template <typename Value>
void InterfaceContent::append(const Value* values, std::size_t count) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(values, count));
    content_.insert(content_.end(), bytes.begin(), bytes.end());
}

// Of what the triangles of a draw cover, where it is not clipped.
void InterfaceContent::add_bounds(const ImDrawList& list, const ImDrawCmd& command, const ImDrawData& data) {
    constexpr float kFar = std::numeric_limits<float>::max();
    Bounds bounds{kFar, kFar, -kFar, -kFar};
    for (unsigned int i = 0; i < command.ElemCount; ++i) {
        const int index = static_cast<int>(command.VtxOffset) + list.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
        const ImVec2& at = list.VtxBuffer[index].pos;
        bounds = {std::min(bounds.left, at.x), std::min(bounds.top, at.y), std::max(bounds.right, at.x),
                  std::max(bounds.bottom, at.y)};
    }
    const ImVec4& clip = command.ClipRect;
    bounds = {std::max(bounds.left, clip.x), std::max(bounds.top, clip.y), std::min(bounds.right, clip.z),
              std::min(bounds.bottom, clip.w)};
    if (bounds.left >= bounds.right || bounds.top >= bounds.bottom) return;
    const ImVec2 scale = data.FramebufferScale, origin = data.DisplayPos;
    draws_.push_back({(bounds.left - origin.x) * scale.x, (bounds.top - origin.y) * scale.y,
                      (bounds.right - origin.x) * scale.x, (bounds.bottom - origin.y) * scale.y});
}

void InterfaceContent::take() {
    std::swap(content_, last_);
    content_.clear();
    draws_.clear();
    const ImDrawData& data = *ImGui::GetDrawData();
    append(&data.DisplayPos, 1);
    append(&data.DisplaySize, 1);
    append(&data.FramebufferScale, 1);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            append(&command.ClipRect, 1);
            append(&command.TextureId, 1);
            append(&command.VtxOffset, 1);
            append(&command.IdxOffset, 1);
            append(&command.ElemCount, 1);
            add_bounds(list, command, data);
        }
        append(list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size));
        append(list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.Size));
    }
    if (content_ != last_) ++revision_;
}

bool InterfaceContent::within(std::span<const PixelRect> parts) const {
    // Where a panel's edge is between two pixels, its part ends at the nearer.
    constexpr float kEdge = 0.5F;
    return std::ranges::all_of(draws_, [&](const Bounds& draw) {
        return std::ranges::any_of(parts, [&](const PixelRect& part) {
            const auto left = static_cast<float>(part.x), top = static_cast<float>(part.y);
            return draw.left >= left - kEdge && draw.top >= top - kEdge &&
                   draw.right <= left + static_cast<float>(part.width) + kEdge &&
                   draw.bottom <= top + static_cast<float>(part.height) + kEdge;
        });
    });
}

}  // namespace splice
