// Sections of the side panel: what is shown and how.
#include "engine/viewer/added_light.h"
#include "engine/viewer/panels.h"

#include <glm/gtc/type_ptr.hpp>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace splice {

namespace {

// A list of a table of names; the lists are those of the programs' options.
template <typename Value, std::size_t N>
void choose(const char* label, const Names<Value, N>& names, Value& value) {
    const std::string shown(name_in(names, value));
    if (!ImGui::BeginCombo(label, shown.c_str(), ImGuiComboFlags_HeightLarge)) return;
    for (const Named<Value>& known : names) {
        const std::string name(known.name), description(known.description);
        if (ImGui::Selectable(name.c_str(), known.value == value)) value = known.value;
        if (!description.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", description.c_str());
    }
    ImGui::EndCombo();
}

bool edit_colour(const char* label, glm::dvec3& colour, ImGuiColorEditFlags flags) {
    glm::vec3 shown(colour);
    if (!ImGui::ColorEdit3(label, glm::value_ptr(shown), flags | ImGuiColorEditFlags_NoInputs)) return false;
    colour = glm::dvec3(shown);
    return true;
}

bool edit_number(const char* label, double& value, float least, float most, const char* format = "%.2f") {
    auto shown = static_cast<float>(value);
    if (!ImGui::SliderFloat(label, &shown, least, most, format, ImGuiSliderFlags_AlwaysClamp)) return false;
    value = shown;
    return true;
}

// The published ones; scripts and scene files know all.
void choose_kernel(Kernel& kernel) {
    const std::string shown = text_of(kernel);
    if (!ImGui::BeginCombo("Kernel", shown.c_str())) return;
    for (const char* text : {"disk", "gaussian:0.3", "gaussian:0.5", "gaussian:0.8", "confetti:1,1.5,2",
                             "confetti:6,1.5,3", "confetti:4,1.5,5", "constant"})
        if (ImGui::Selectable(text, shown == text)) kernel = parse_kernel(text).value_or(Kernel{});
    ImGui::EndCombo();
}

bool edit_vector(const char* label, glm::dvec3& value) {
    glm::vec3 shown(value);
    if (!ImGui::DragFloat3(label, glm::value_ptr(shown), 0.02F, -1e6F, 1e6F, "%.2f")) return false;
    value = glm::dvec3(shown);
    return true;
}

bool edit_light(Light& light) {
    bool changed = false;
    int kind = static_cast<int>(light.kind), space = static_cast<int>(light.space);
    changed |= ImGui::Combo("Kind", &kind, "directional\0point\0");
    changed |= ImGui::Combo("Moves with", &space, "the camera\0the world\0");
    light.kind = static_cast<LightKind>(kind);
    light.space = static_cast<LightSpace>(space);
    // One number for strength and a colour of full brightness are easier to set than three numbers above 1.
    double strength = std::max({light.colour.r, light.colour.g, light.colour.b, 1e-6});
    glm::dvec3 hue = light.colour / strength;
    changed |= edit_number("Strength", strength, 0, 3);
    changed |= edit_colour("Colour", hue, ImGuiColorEditFlags_Float);
    light.colour = hue * strength;
    if (light.kind == LightKind::kDirectional) {
        glm::dvec3 direction = light.direction;
        changed |= edit_vector("Direction", direction);
        if (glm::length(direction) > 1e-6) light.direction = direction;
    } else {
        changed |= edit_vector("Position", light.position);
        changed |= edit_number("Range", light.range, 0.01F, 100, "%.2f");
    }
    return changed;
}

}  // namespace

void draw_view_section(PanelContext& context) {
    ViewerState& state = context.state;
    choose("Compare", kComparisonNames, state.comparison);
    if (state.comparison == Comparison::kOff) {
        state.edited_look = 0;
    } else {
        int edited = static_cast<int>(state.edited_look);
        ImGui::RadioButton("Left", &edited, 0);
        ImGui::SameLine();
        ImGui::RadioButton("Right", &edited, 1);
        state.edited_look = static_cast<std::size_t>(edited);
    }
    CaptureSettings& look = state.looks[state.edited_look];
    choose("View", kViewNames, look.view);
    choose("Show", kShownNames, look.shown);
    choose("Backend", kBackendNames, look.backend);
    choose("Shading", kShadingNames, look.shading);
    choose("Sides", kSidesNames, look.sides);
    edit_number("Epsilon", look.epsilon_scale, 0, 4);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("How far surfels may lie behind one another and still blend");
    ImGui::Checkbox("Prefilter", &look.prefilter);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("EWA's screen-space low-pass filter");
    int samples = static_cast<int>(look.antialias);
    if (ImGui::SliderInt("Antialias", &samples, 1, static_cast<int>(kMostSamplesPerSide), "%d per side"))
        look.antialias = static_cast<std::uint32_t>(std::clamp(samples, 1, static_cast<int>(kMostSamplesPerSide)));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Samples along each side of a pixel; one while the camera moves");
    edit_number("Merge", look.merge_px, 0, 8, "%.1f px");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("How far fewer, merged surfels may move any of those they stand for; 0: every surfel");
    edit_number("Tau", look.tau, 0, 8, "%.1f px");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("How long an ellipse may be that stands for many surfels; 0: full detail");
    choose_kernel(look.kernel);
    ImGui::Checkbox("Freeze levels", &state.freeze_cut);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Levels of detail stay as chosen from here, to fly around them");
    ImGui::Checkbox("Coarser while moving", &state.reduce_while_moving);
    if (state.reduce_while_moving) {
        edit_number("Budget", state.moving_budget_ms, 5, 200, "%.0f ms");
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("What a frame may take while the camera moves");
        edit_number("Most tau", state.moving_most_tau, 0, static_cast<float>(MovingDetail::kCoarsest),
                    "%.0f px moving");
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip(
                "How coarse levels of detail may grow while the camera moves, where half the pixels a\n"
                "side take longer than the budget; 0: they stay as at rest");
    }
    if (!state.scene) return;
    Background& background = state.scene->loaded.scene.background;
    bool changed = ImGui::Checkbox("Transparent", &background.transparent);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Alpha of screenshots is coverage");
    ImGui::BeginDisabled(background.transparent);
    if (edit_colour("Background", background.colour, ImGuiColorEditFlags_Uint8)) {
        // What scene files and command lines can say.
        background.colour = glm::round(background.colour * 255.0) / 255.0;
        changed = true;
    }
    ImGui::EndDisabled();
    if (changed) ++state.scene_revision;
}

void draw_camera_section(PanelContext& context) {
    ViewerState& state = context.state;
    bool orthographic = state.camera.orthographic();
    if (ImGui::Checkbox("Parallel rays (5)", &orthographic)) state.camera.set_orthographic(orthographic);
    bool trackball = state.navigation.style == OrbitStyle::kTrackball;
    if (ImGui::Checkbox("Trackball", &trackball))
        state.navigation.style = trackball ? OrbitStyle::kTrackball : OrbitStyle::kTurntable;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Turn about the camera's own axes, not the world's up");
    const Camera camera = state.camera.camera();
    const auto row = [](const char* name, const glm::dvec3& v) {
        ImGui::Text("%s  %.4g  %.4g  %.4g", name, v.x, v.y, v.z);
    };
    row("Eye", camera.eye);
    row("Pivot", state.camera.pivot());
    if (ImGui::Button("Copy as splice-capture command")) context.commands.push_back({"copy-camera", {}});
}

void draw_light_section(PanelContext& context) {
    ViewerState& state = context.state;
    if (!state.scene) {
        ImGui::TextDisabled("no scene");
        return;
    }
    Lighting& lighting = state.scene->loaded.scene.lighting;
    bool changed = edit_colour("Ambient", lighting.ambient, ImGuiColorEditFlags_Float);
    changed |= edit_number("Specular", lighting.specular, 0, 2);
    if (lighting.specular > 0) {
        changed |= edit_number("Shininess", lighting.shininess, 1, 256, "%.0f");
        int model = static_cast<int>(lighting.highlight);
        changed |= ImGui::Combo("Highlights", &model, "Blinn-Phong\0Phong\0");
        lighting.highlight = static_cast<HighlightModel>(model);
    }
    changed |= edit_number("Rim", lighting.rim, 0, 2);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("White towards outlines, whatever the lights");
    if (lighting.rim > 0) changed |= edit_number("Narrowness", lighting.rim_exponent, 1, 16, "%.1f");
    std::size_t removed = lighting.lights.size();
    for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        ImGui::Separator();
        changed |= edit_light(lighting.lights[i]);
        if (ImGui::SmallButton("Remove")) removed = i;
        ImGui::PopID();
    }
    if (removed < lighting.lights.size()) {
        lighting.lights.erase(lighting.lights.begin() + static_cast<std::ptrdiff_t>(removed));
        changed = true;
    }
    ImGui::Separator();
    if (ImGui::Button("Add a light")) {
        lighting.lights.push_back(added_light(lighting, state.camera.camera()));
        changed = true;
    }
    if (changed) ++state.scene_revision;
}

}  // namespace splice
