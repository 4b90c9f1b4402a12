#include "engine/viewer/settings_file.h"

#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace splice {

namespace {

template <typename T>
void take(const nlohmann::json& json, const char* name, T& value) {
    const auto found = json.find(name);
    if (found == json.end()) return;
    if constexpr (std::is_same_v<T, bool>) {
        if (found->is_boolean()) value = found->template get<bool>();
    } else if constexpr (std::is_same_v<T, std::string>) {
        if (found->is_string()) value = found->template get<std::string>();
    } else {
        constexpr std::int64_t most = 16384;
        if (found->is_number_integer() && *found >= 64 && *found <= most) value = found->template get<T>();
    }
}

}  // namespace

std::optional<std::filesystem::path> settings_path() {
    // Relative paths are to be passed over (XDG Base Directory Specification).
    const char* config = std::getenv("XDG_CONFIG_HOME");
    if (config != nullptr && config[0] == '/') return std::filesystem::path(config) / "splice" / "view.json";
    const char* home = std::getenv("HOME");
    if (home != nullptr && home[0] == '/') return std::filesystem::path(home) / ".config" / "splice" / "view.json";
    return std::nullopt;
}

ViewerSettings parse_settings(std::string_view text) {
    ViewerSettings settings;
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return settings;
    take(json, "width", settings.width);
    take(json, "height", settings.height);
    take(json, "panels", settings.panels);
    take(json, "trackball", settings.trackball);
    take(json, "coarser_while_moving", settings.reduce_while_moving);
    take(json, "prefilter", settings.prefilter);
    take(json, "backend", settings.backend);
    take(json, "present_mode", settings.present_mode);
    return settings;
}

std::string write_settings(const ViewerSettings& settings) {
    const nlohmann::ordered_json json{{"width", settings.width},
                                      {"height", settings.height},
                                      {"panels", settings.panels},
                                      {"trackball", settings.trackball},
                                      {"coarser_while_moving", settings.reduce_while_moving},
                                      {"prefilter", settings.prefilter},
                                      {"backend", settings.backend},
                                      {"present_mode", settings.present_mode}};
    return json.dump(2) + "\n";
}

ViewerSettings read_settings() {
    const auto path = settings_path();
    if (!path) return {};
    std::ifstream file(*path, std::ios::binary);
    return parse_settings(std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()));
}

void save_settings(const ViewerSettings& settings) {
    const auto path = settings_path();
    if (!path) return;
    std::error_code status;
    std::filesystem::create_directories(path->parent_path(), status);
    try {
        write_text_file(*path, write_settings(settings));
    } catch (const SystemError&) {
        // A window that could not remember is none the worse.
    }
}

void apply_settings(const ViewerSettings& settings, ViewerState& state) {
    state.panels = settings.panels;
    state.navigation.style = settings.trackball ? OrbitStyle::kTrackball : OrbitStyle::kTurntable;
    state.reduce_while_moving = settings.reduce_while_moving;
    for (CaptureSettings& look : state.looks) {
        look.prefilter = settings.prefilter;
        look.backend = find_named(kBackendNames, settings.backend).value_or(Backend::kAuto);
    }
    state.present_mode = gpu::present_mode_of_name(settings.present_mode).value_or(gpu::PresentMode::fifo);
}

ViewerSettings settings_of(const ViewerState& state, std::uint32_t width, std::uint32_t height) {
    ViewerSettings settings{.width = width, .height = height};
    settings.panels = state.panels;
    settings.trackball = state.navigation.style == OrbitStyle::kTrackball;
    settings.reduce_while_moving = state.reduce_while_moving;
    settings.prefilter = state.looks[0].prefilter;
    settings.backend = std::string(name_of(state.looks[0].backend));
    settings.present_mode = std::string(gpu::kPresentModeNames[static_cast<std::size_t>(state.present_mode)].name);
    return settings;
}

}  // namespace splice
