// A section of the side panel: times of passes as a rolling plot, counts and memory.
#include "engine/viewer/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace splice {

namespace {

ImU32 pass_colour(std::size_t index, bool dim) {
    float r = 0, g = 0, b = 0;
    // The golden angle spreads hues of any count.
    ImGui::ColorConvertHSVtoRGB(static_cast<float>(index) * 0.381966F, 0.6F, dim ? 0.45F : 0.95F, r, g, b);
    return ImGui::GetColorU32({r, g, b, 1});
}

// Stacked columns, one a frame, the newest to the right.
void plot(const PassHistory& history, int lit) {
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    constexpr float kLines = 5.6F;  // of text, its height
    const ImVec2 size{ImGui::GetContentRegionAvail().x, kLines * ImGui::GetFontSize()};
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(origin, {origin.x + size.x, origin.y + size.y}, IM_COL32(30, 32, 36, 255));
    std::array<float, PassHistory::kFrames> totals{};
    for (const PassHistory::Series& series : history.series())
        for (std::size_t i = 0; i < totals.size(); ++i)
            totals[i] += series.ms[i];
    const float most = std::max(*std::max_element(totals.begin(), totals.end()), 1.0F) * 1.1F;
    const float column = size.x / static_cast<float>(PassHistory::kFrames);
    for (std::size_t i = 0; i < PassHistory::kFrames; ++i) {
        const std::size_t frame = (history.oldest() + i) % PassHistory::kFrames;
        const float left = origin.x + static_cast<float>(i) * column;
        float bottom = origin.y + size.y;
        for (std::size_t s = 0; s < history.series().size(); ++s) {
            const float height = history.series()[s].ms[frame] / most * size.y;
            const bool dim = lit >= 0 && static_cast<int>(s) != lit;
            list.AddRectFilled({left, bottom - height}, {left + column, bottom}, pass_colour(s, dim));
            bottom -= height;
        }
    }
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.0f ms", static_cast<double>(most));
    list.AddText({origin.x + 4, origin.y + 2}, IM_COL32(200, 204, 210, 255), text.data());
}

}  // namespace

void draw_performance_section(PanelContext& context) {
    ViewerState& state = context.state;
    const auto& series = state.measured.history.series();
    int lit = -1;
    const auto& passes = state.measured.graph.passes;
    // The graph may have become shorter since its pass was lit.
    const bool lit_now = state.lit_pass >= 0 && static_cast<std::size_t>(state.lit_pass) < passes.size();
    for (std::size_t s = 0; lit_now && s < series.size(); ++s)
        if (passes[static_cast<std::size_t>(state.lit_pass)].name == series[s].name) lit = static_cast<int>(s);
    plot(state.measured.history, lit);
    for (std::size_t s = 0; s < series.size(); ++s) {
        const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(pass_colour(s, lit >= 0 && static_cast<int>(s) != lit));
        ImGui::TextColored(colour, "%-18s", series[s].name.c_str());
        ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.72F);
        ImGui::Text("%.2f ms", static_cast<double>(series[s].last));
    }
    ImGui::Text("%.1f frames/s", state.measured.frames_per_second);
    if (state.measured.stats.overlap_mean > 0)
        ImGui::Text("overlap %.2f surfels a pixel", state.measured.stats.overlap_mean);
    else
        ImGui::TextDisabled("overlap: in the view of that name");
    const PatchCounts& patches = state.measured.stats.patches;
    ImGui::Text("patches outside %s, facing away %s", grouped(patches.outside_frustum).c_str(),
                grouped(patches.facing_away).c_str());
    const CutStats& cut = state.measured.stats.cut;
    if (cut.tau > 0) {
        ImGui::Text("levels chosen in %.2f ms, %s nodes", cut.select_ms + cut.gather_ms,
                    grouped(cut.counts.visited).c_str());
        ImGui::Text("nodes outside %s, facing away %s", grouped(cut.counts.outside_frustum).c_str(),
                    grouped(cut.counts.facing_away).c_str());
        ImGui::Text("%s ellipses for %s surfels", grouped(cut.counts.ellipses).c_str(),
                    grouped(cut.counts.merged_surfels).c_str());
        ImGui::Text("%s patches by triangles", grouped(cut.counts.patches_by_triangles).c_str());
    }
    if (const PageStats& pages = state.measured.stats.pages; pages.limit_bytes > 0) {
        ImGui::Text("surfels held %s of %s", megabytes(pages.resident_bytes).c_str(),
                    megabytes(pages.limit_bytes).c_str());
        ImGui::Text("%s blocks read, %s surfels missing", grouped(pages.blocks_read).c_str(),
                    grouped(pages.missing_surfels).c_str());
    }
    ImGui::Text("device memory %s", megabytes(state.measured.device_bytes).c_str());
    ImGui::Text("attachments %s", megabytes(state.measured.attachment_bytes).c_str());
    ImGui::TextWrapped("%s", state.device_name.c_str());
    if (!context.shader_status.empty()) ImGui::TextWrapped("%s", context.shader_status.c_str());
    ImGui::Checkbox("Render graph", &state.graph_window);
}

}  // namespace splice
