#include "engine/viewer/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace splice {

namespace {

constexpr float kPanelWidth = 300, kNarrowPanelWidth = 216;  // at scale 1
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoSavedSettings;
constexpr ImU32 kErrorColour = IM_COL32(255, 140, 115, 255);

void draw_progress(const SceneJob::Progress& progress, const Layout& layout) {
    const float gap = 10 * layout.scale;
    const float width = std::min(360 * layout.scale, layout.width - layout.panel_width - 2 * gap);
    ImGui::SetNextWindowPos({layout.panel_width + (layout.width - layout.panel_width - width) / 2, gap});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin("progress", nullptr, kFixed | ImGuiWindowFlags_NoFocusOnAppearing);
    const std::string stage = progress.stage.empty() ? "reading" : progress.stage;
    ImGui::ProgressBar(static_cast<float>(progress.fraction), {-1, 0}, stage.c_str());
    ImGui::End();
}

void draw_messages(PanelContext& context, const Layout& layout) {
    if (context.state.messages.empty()) return;
    const float gap = 10 * layout.scale;
    const float width = std::min(560 * layout.scale, layout.width - layout.panel_width - 2 * gap);
    // Below the progress bar, clear of the render graph.
    ImGui::SetNextWindowPos({layout.panel_width + gap, 56 * layout.scale});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin("messages", nullptr, kFixed | ImGuiWindowFlags_NoFocusOnAppearing);
    for (const Message& message : context.state.messages) {
        if (message.error) ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
        ImGui::TextWrapped("%s", message.text.c_str());
        if (message.error) ImGui::PopStyleColor();
    }
    if (ImGui::SmallButton("Close")) context.state.messages.clear();
    ImGui::End();
}

void draw_hint(const Layout& layout) {
    const char* hint = "Drop a .splice model, a scene or a mesh here";
    const ImVec2 size = ImGui::CalcTextSize(hint);
    ImGui::GetBackgroundDrawList()->AddText({layout.panel_width + (layout.width - layout.panel_width - size.x) / 2,
                                             (layout.height - layout.status_height - size.y) / 2},
                                            IM_COL32(200, 204, 210, 255), hint);
}

void label(ImDrawList& list, float x, float y, const std::string& text, bool to_the_left) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float left = to_the_left ? x - size.x - 8 : x + 8;
    list.AddRectFilled({left - 4, y - 2}, {left + size.x + 4, y + size.y + 2}, IM_COL32(20, 22, 25, 190), 3);
    list.AddText({left, y}, IM_COL32(235, 235, 235, 255), text.c_str());
}

std::string caption(const CaptureSettings& look) {
    std::string text(name_of(look.view));
    if (look.shown != Shown::kHybrid) text += ", " + std::string(name_of(look.shown));
    return text;
}

void draw_divider(const ViewerState& state, const Layout& layout) {
    if (state.comparison == Comparison::kOff || !state.scene) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const double share = state.comparison == Comparison::kWipe ? state.wipe : 0.5;
    const float x = layout.panel_width + static_cast<float>(share) * (layout.width - layout.panel_width);
    const float bottom = layout.height - layout.status_height;
    list.AddLine({x, 0}, {x, bottom}, IM_COL32(20, 22, 25, 255), 3);
    list.AddLine({x, 0}, {x, bottom}, IM_COL32(235, 235, 235, 255), 1);
    label(list, x, bottom - ImGui::GetFontSize() - 8, caption(state.looks[0]), true);
    label(list, x, bottom - ImGui::GetFontSize() - 8, caption(state.looks[1]), false);
}

}  // namespace

std::string grouped(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3)
        text.insert(at - 3, ",");
    return text;
}

std::string megabytes(std::uint64_t bytes) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f MB", static_cast<double>(bytes) / 1e6);
    return text.data();
}

Layout lay_out(float width, float height, float scale, bool panels) {
    Layout layout{.width = width, .height = height, .scale = scale};
    if (!panels) return layout;
    layout.panel_width = std::min((width < 900 * scale ? kNarrowPanelWidth : kPanelWidth) * scale, width * 0.5F);
    layout.status_height = std::min(26 * scale, height * 0.5F);
    return layout;
}

void draw_side_panel(PanelContext& context, const Layout& layout) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({layout.panel_width, layout.height});
    ImGui::Begin("panel", nullptr, kFixed);
    // Labels stand to the right of what they name and need their share.
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.55F);
    struct Section {
        const char* title;
        void (*draw)(PanelContext&);
        bool open;
    };
    constexpr std::array<Section, 7> sections{{{"View", draw_view_section, true},
                                               {"Model and bake", draw_model_section, true},
                                               {"Picked", draw_picked_section, true},
                                               {"Performance", draw_performance_section, true},
                                               {"Camera", draw_camera_section, false},
                                               {"Lights", draw_light_section, false},
                                               {"Files", draw_file_section, false}}};
    for (const Section& section : sections) {
        if (!ImGui::CollapsingHeader(section.title, section.open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) continue;
        ImGui::PushID(section.title);
        section.draw(context);
        ImGui::PopID();
        ImGui::Spacing();
    }
    ImGui::PopItemWidth();
    ImGui::End();
}

void draw_status_bar(PanelContext& context, const Layout& layout) {
    const ViewerState& state = context.state;
    ImGui::SetNextWindowPos({layout.panel_width, layout.height - layout.status_height});
    ImGui::SetNextWindowSize({layout.width - layout.panel_width, layout.status_height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8, 4});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
    std::string text;
    if (state.scene) {
        text = std::to_string(state.measured.drawn_width) + " x " + std::to_string(state.measured.drawn_height);
        const bool reduced = state.measured.stats.frame_ms > 0 && state.looks[0].width > state.measured.drawn_width;
        if (state.measured.drawn_coarser) {
            std::array<char, 32> tau{};
            std::snprintf(tau.data(), tau.size(), ", tau %.1f px", state.measured.stats.cut.tau);
            text += tau.data();
        }
        if (reduced || state.measured.drawn_coarser) text += " while moving";
        std::array<char, 64> numbers{};
        std::snprintf(numbers.data(), numbers.size(), "   %.1f ms   ", state.measured.stats.frame_ms);
        text += numbers.data() + grouped(state.measured.stats.surfels_drawn) + " surfels, " +
                grouped(state.measured.stats.triangles_drawn) + " triangles   " +
                std::string(name_of(state.measured.stats.backend));
    }
    ImGui::TextUnformatted(text.c_str());
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void draw_overlays(PanelContext& context, const Layout& layout) {
    draw_divider(context.state, layout);
    if (context.progress) draw_progress(*context.progress, layout);
    draw_messages(context, layout);
    if (!context.state.scene && !context.progress) draw_hint(layout);
}

}  // namespace splice
