// The interface as functions of the state: each draws itself with Dear ImGui and changes settings in the state; what is
// more than a setting becomes a command.
#pragma once

#include "engine/viewer/script.h"
#include "engine/viewer/viewer_state.h"

#include <optional>
#include <string>
#include <vector>

namespace splice {

/// In the window's screen coordinates.
struct Layout {
    float width = 0, height = 0;  // of the window
    float panel_width = 0;        // 0: no panel
    float status_height = 0;
    float scale = 1;  // of the monitor: letters and gaps are so many times as large
};
Layout lay_out(float width, float height, float scale, bool panels);

struct PanelContext {
    ViewerState& state;
    std::vector<Command>& commands;
    const std::optional<SceneJob::Progress>& progress;  // of the scene that is being loaded
    std::string shader_status;                          // empty where shaders are not watched
};

void draw_side_panel(PanelContext& context, const Layout& layout);
void draw_status_bar(PanelContext& context, const Layout& layout);
/// What floats over the picture: progress, messages, the line of the wipe, a hint where nothing is open.
void draw_overlays(PanelContext& context, const Layout& layout);
void draw_graph_window(PanelContext& context, const Layout& layout);

// Sections of the side panel.
void draw_view_section(PanelContext& context);
void draw_camera_section(PanelContext& context);
void draw_light_section(PanelContext& context);
void draw_model_section(PanelContext& context);
void draw_picked_section(PanelContext& context);
void draw_performance_section(PanelContext& context);
void draw_file_section(PanelContext& context);

/// "1,234,567"; "12.3 MB".
std::string grouped(std::uint64_t number);
std::string megabytes(std::uint64_t bytes);

}  // namespace splice
