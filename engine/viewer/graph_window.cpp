// The frame's render graph as compiled: a box a pass, those of one render pass in a frame, an arrow for each resource
// handed on. The pass under the cursor is lit, with what it reads and writes, here and in the plot of times.
#include "engine/viewer/panels.h"
#include "preprocess/build_model/counted.h"

#include <imgui.h>

#include <algorithm>
#include <vector>

namespace splice {

namespace {

constexpr float kGap = 26, kPadding = 8, kArrow = 5;

struct PassBox {
    std::uint32_t pass = 0;
    ImVec2 minimum, maximum;
};

struct GraphDrawing {
    std::vector<PassBox> boxes;
    std::vector<PassBox> groups;
    ImVec2 size{0, 0};
};

// Passes in recorded order from left to right, wrapped where the window ends.
GraphDrawing lay_out_graph(const graph::FramePicture& picture, const ImVec2& origin, float width) {
    GraphDrawing drawing;
    const float text_height = ImGui::GetFontSize();
    const float row_height = text_height + 2 * kPadding + kGap + text_height;
    float x = kPadding, y = kPadding;
    for (const graph::FramePicture::Group& group : picture.groups) {
        const bool framed = group.passes.size() > 1;
        float needed = 0;
        for (const std::uint32_t pass : group.passes)
            needed += ImGui::CalcTextSize(picture.passes[pass].name.c_str()).x + 2 * kPadding + kGap;
        if (x > kPadding && x + needed > width) {
            x = kPadding;
            y += row_height;
        }
        const float group_left = x;
        for (const std::uint32_t pass : group.passes) {
            const float box = ImGui::CalcTextSize(picture.passes[pass].name.c_str()).x + 2 * kPadding;
            if (x > kPadding && x + box > width) {
                x = kPadding;
                y += row_height;
            }
            const ImVec2 minimum{origin.x + x, origin.y + y + text_height};
            drawing.boxes.push_back({pass, minimum, {minimum.x + box, minimum.y + text_height + 2 * kPadding}});
            x += box + kGap;
            drawing.size.x = std::max(drawing.size.x, x);
        }
        if (framed && !drawing.boxes.empty() && drawing.boxes.back().minimum.x > origin.x + group_left)
            drawing.groups.push_back({group.passes.front(),
                                      {origin.x + group_left - 5, drawing.boxes.back().minimum.y - 5},
                                      {drawing.boxes.back().maximum.x + 5, drawing.boxes.back().maximum.y + 5}});
    }
    drawing.size.y = y + row_height;
    return drawing;
}

void draw_arrow(ImDrawList& list, const PassBox& from, const PassBox& to, std::size_t lane, ImU32 colour) {
    const bool same_row = from.minimum.y == to.minimum.y;
    if (same_row && from.maximum.x + kGap + 1 >= to.minimum.x) {
        const float y = (from.minimum.y + from.maximum.y) / 2;
        list.AddLine({from.maximum.x, y}, {to.minimum.x, y}, colour, 1.5F);
        list.AddTriangleFilled({to.minimum.x, y}, {to.minimum.x - kArrow, y - kArrow},
                               {to.minimum.x - kArrow, y + kArrow}, colour);
        return;
    }
    // Under the boxes; lanes keep arrows of different passes apart.
    const float drop = from.maximum.y + 8 + static_cast<float>(lane % 4) * 4;
    const float a = (from.minimum.x + from.maximum.x) / 2, b = to.minimum.x + 10 + static_cast<float>(lane % 4) * 5;
    const float end = same_row ? to.maximum.y : to.minimum.y;
    list.AddLine({a, from.maximum.y}, {a, drop}, colour, 1.5F);
    list.AddLine({a, drop}, {b, drop}, colour, 1.5F);
    list.AddLine({b, drop}, {b, end}, colour, 1.5F);
    const float back = same_row ? kArrow : -kArrow;
    list.AddTriangleFilled({b, end}, {b - kArrow, end + back}, {b + kArrow, end + back}, colour);
}

void describe(const graph::FramePicture& picture, std::uint32_t index, const PassHistory& history) {
    const graph::FramePicture::Pass& pass = picture.passes[index];
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(pass.name.c_str());
    for (const PassHistory::Series& series : history.series())
        if (series.name == pass.name) ImGui::Text("%.2f ms", static_cast<double>(series.last));
    for (const graph::FramePicture::Use& use : pass.uses) {
        const graph::FramePicture::Resource& resource = picture.resources[use.resource];
        ImGui::Text("%s %s  %s", use.how, resource.name.c_str(), resource.format.c_str());
    }
    for (const graph::FramePicture::Group& group : picture.groups)
        if (!group.passes.empty() && group.passes.front() == index && !group.barriers.empty())
            ImGui::TextUnformatted((counted(group.barriers.size(), "barrier") + " before").c_str());
    ImGui::EndTooltip();
}

}  // namespace

void draw_graph_window(PanelContext& context, const Layout& layout) {
    ViewerState& state = context.state;
    state.lit_pass = -1;
    if (!state.graph_window) return;
    const float free_width = layout.width - layout.panel_width;
    const float height = std::min(210.0F, layout.height * 0.45F);
    ImGui::SetNextWindowPos({layout.panel_width + 10, layout.height - layout.status_height - height - 10},
                            ImGuiCond_Appearing);
    ImGui::SetNextWindowSize({free_width - 20, height}, ImGuiCond_Appearing);
    ImGui::Begin("Render graph", &state.graph_window, ImGuiWindowFlags_HorizontalScrollbar);
    const graph::FramePicture& picture = state.measured.graph;
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const GraphDrawing drawing = lay_out_graph(picture, origin, ImGui::GetContentRegionAvail().x);
    if (ImGui::IsWindowHovered())
        for (const PassBox& box : drawing.boxes)
            if (ImGui::IsMouseHoveringRect(box.minimum, box.maximum)) state.lit_pass = static_cast<int>(box.pass);

    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const PassBox& group : drawing.groups)
        list.AddRect(group.minimum, group.maximum, IM_COL32(110, 130, 160, 255), 4);
    const auto box_of = [&](std::uint32_t pass) {
        return std::find_if(drawing.boxes.begin(), drawing.boxes.end(),
                            [&](const PassBox& box) { return box.pass == pass; });
    };
    std::vector<std::uint32_t> near_lit;
    std::size_t lane = 0;
    for (const graph::FramePicture::Edge& edge : picture.edges) {
        const auto from = box_of(edge.from), to = box_of(edge.to);
        if (from == drawing.boxes.end() || to == drawing.boxes.end()) continue;
        const bool lit = state.lit_pass == static_cast<int>(edge.from) || state.lit_pass == static_cast<int>(edge.to);
        if (lit) near_lit.insert(near_lit.end(), {edge.from, edge.to});
        draw_arrow(list, *from, *to, lane++, lit ? IM_COL32(255, 200, 90, 255) : IM_COL32(120, 124, 130, 255));
    }
    for (const PassBox& box : drawing.boxes) {
        const bool lit = state.lit_pass == static_cast<int>(box.pass);
        const bool neighbour = std::find(near_lit.begin(), near_lit.end(), box.pass) != near_lit.end();
        list.AddRectFilled(box.minimum, box.maximum,
                           lit         ? IM_COL32(190, 130, 40, 255)
                           : neighbour ? IM_COL32(90, 75, 50, 255)
                                       : IM_COL32(52, 60, 72, 255),
                           3);
        list.AddText({box.minimum.x + kPadding, box.minimum.y + kPadding}, IM_COL32(235, 235, 235, 255),
                     picture.passes[box.pass].name.c_str());
    }
    ImGui::Dummy(drawing.size);
    if (state.lit_pass >= 0) describe(picture, static_cast<std::uint32_t>(state.lit_pass), state.measured.history);
    ImGui::End();
}

}  // namespace splice
