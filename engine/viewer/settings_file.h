// What a window remembers from one time to the next: $XDG_CONFIG_HOME/splice/view.json, else
// ~/.config/splice/view.json.
#pragma once

#include "engine/viewer/viewer_state.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace splice {

struct ViewerSettings {
    std::uint32_t width = 1280, height = 720;  // of the window
    bool panels = true;
    bool trackball = false;
    bool reduce_while_moving = true;
    bool prefilter = true;
    std::string backend = "auto", present_mode = "fifo";
};

/// Nothing where neither variable is set.
std::optional<std::filesystem::path> settings_path();

/// Defaults for what the text lacks or has in another form: a settings file never keeps a window from opening.
ViewerSettings parse_settings(std::string_view text);
std::string write_settings(const ViewerSettings& settings);

ViewerSettings read_settings();
/// Failures are passed over.
void save_settings(const ViewerSettings& settings);

void apply_settings(const ViewerSettings& settings, ViewerState& state);
ViewerSettings settings_of(const ViewerState& state, std::uint32_t width, std::uint32_t height);

}  // namespace splice
