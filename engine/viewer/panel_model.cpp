// Sections of the side panel: the model, how it is baked, what of it was picked, and files.
#include "engine/viewer/panels.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace splice {

namespace {

void edit_bake(PanelContext& context) {
    BakeOptions& bake = context.state.bake;
    int representation = static_cast<int>(bake.cluster.representation);
    ImGui::Combo("Represent", &representation, "hybrid\0triangles\0surfels\0");
    bake.cluster.representation = static_cast<ForcedRepresentation>(representation);
    if (bake.cluster.representation == ForcedRepresentation::kHybrid) {
        bool by_share = bake.cluster.triangle_share.has_value();
        int selection = by_share ? 2 : static_cast<int>(bake.cluster.selection);
        ImGui::Combo("Select", &selection, "by roughness\0as published\0by share\0");
        if (selection == 2) {
            if (!bake.cluster.triangle_share) bake.cluster.triangle_share = 0.19;
            auto share = static_cast<float>(*bake.cluster.triangle_share);
            if (ImGui::SliderFloat("Triangles", &share, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp))
                bake.cluster.triangle_share = share;
            bake.cluster.selection = Selection::kGeometric;
        } else {
            bake.cluster.triangle_share.reset();
            bake.cluster.selection = static_cast<Selection>(selection);
        }
    } else {
        bake.cluster.triangle_share.reset();
    }
    if (bake.cluster.representation != ForcedRepresentation::kTriangles) {
        int sampling = bake.sampling.thesis_c ? 1 : 0;
        ImGui::Combo("Sampling", &sampling, "adaptive\0as published\0");
        if (sampling == 1) {
            if (!bake.sampling.thesis_c) bake.sampling.thesis_c = 1;
            auto c = static_cast<float>(*bake.sampling.thesis_c);
            if (ImGui::SliderFloat("Density", &c, 0.25F, 4, "%.2f", ImGuiSliderFlags_AlwaysClamp))
                bake.sampling.thesis_c = c;
        } else {
            bake.sampling.thesis_c.reset();
            // As a count along the longest side: 1 / h_max.
            auto count = static_cast<float>(1 / bake.sampling.h_max);
            if (ImGui::SliderFloat("Spacing", &count, 8, 512, "1/%.0f",
                                   ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
                bake.sampling.h_max = 1 / static_cast<double>(count);
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("The widest that surfels may lie apart, as a share of the longest side");
            bake.sampling.h_min = std::min(SamplingOptions{}.h_min, bake.sampling.h_max);
        }
    }
    const bool busy = context.progress.has_value();
    ImGui::BeginDisabled(busy);
    if (ImGui::Button("Bake again (R)")) context.commands.push_back({"rebake", {}});
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Defaults")) bake = BakeOptions{};
}

void row(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(ImGui::GetContentRegionAvail().x * 0.42F);
    ImGui::TextUnformatted(value.c_str());
}

std::string three(double x, double y, double z) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%.4g, %.4g, %.4g", x, y, z);
    return text.data();
}

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", value);
    return text.data();
}

void draw_colour(const std::uint8_t (&rgb)[3]) {
    ImGui::ColorButton("colour", {static_cast<float>(rgb[0]) / 255, static_cast<float>(rgb[1]) / 255,
                                  static_cast<float>(rgb[2]) / 255, 1});
    ImGui::SameLine();
    ImGui::Text("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
}

void draw_surfel(const format::Surfel& surfel) {
    row("Radius", number(float_from_half(surfel.radius)));
    const std::array<float, 3> normal = decode_octahedral(surfel.normal);
    row("Normal", three(normal[0], normal[1], normal[2]));
    draw_colour(surfel.colour);
}

}  // namespace

void draw_model_section(PanelContext& context) {
    ViewerState& state = context.state;
    if (!state.scene) {
        ImGui::TextDisabled("nothing open");
        return;
    }
    const OpenScene& scene = *state.scene;
    ImGui::TextWrapped("%s", scene.name.c_str());
    row("Mesh", grouped(scene.source_triangles) + " triangles");
    row("Patches", grouped(scene.patches));
    row("Triangles", grouped(scene.triangles));
    row("Surfels", grouped(scene.surfels));
    row("In memory", megabytes(scene.bytes));
    if (!scene.bakeable) {
        ImGui::TextDisabled("baked; open its mesh to bake it anew");
        return;
    }
    ImGui::Separator();
    edit_bake(context);
}

void draw_picked_section(PanelContext& context) {
    const ViewerState& state = context.state;
    if (!state.picked || !state.scene) {
        ImGui::TextDisabled("click on the model");
        return;
    }
    const Hit& hit = *state.picked;
    const ModelView& model = *state.scene->pickable[hit.instance].model;
    const format::Patch& patch = model.patches[hit.patch];
    const bool surfel = hit.kind == format::Representation::kSurfels;
    row("Patch", grouped(hit.patch) + (surfel ? ", surfels" : ", triangles"));
    row("Holds", surfel ? grouped(patch.surfel_count) + " surfels"
                        : grouped(model.lods[patch.first_lod].index_count / 3) + " triangles");
    row("Roughness", number(patch.roughness * 57.29578) + " deg");
    row("Area", number(patch.area));
    row(surfel ? "Surfel" : "Triangle", grouped(hit.element));
    row("Place", three(hit.point.x, hit.point.y, hit.point.z));
    if (surfel) {
        draw_surfel(model.surfel(hit.element));
        return;
    }
    row("Normal", three(hit.normal.x, hit.normal.y, hit.normal.z));
    const std::uint64_t first = hit.element * 3;
    row("Vertices", std::to_string(model.indices[first]) + ", " + std::to_string(model.indices[first + 1]) + ", " +
                        std::to_string(model.indices[first + 2]));
    const std::uint32_t colour = model.vertices[model.indices[first]].colour;
    draw_colour({static_cast<std::uint8_t>(colour), static_cast<std::uint8_t>(colour >> 8),
                 static_cast<std::uint8_t>(colour >> 16)});
}

void draw_file_section(PanelContext& context) {
    ViewerState& state = context.state;
    static constexpr const char* kNothingThere = "needs a scene";
    if (!state.scene) {
        ImGui::TextDisabled("%s", kNothingThere);
        return;
    }
    const auto button = [&](const char* label, const Command& command) {
        if (ImGui::Button(label)) context.commands.push_back(command);
    };
    button("Screenshot (P)", {"screenshot", {}});
    ImGui::SameLine();
    button("of the window", {"screenshot-window", {}});
    button("Turntable of 36", {"turntable", {"36"}});
    ImGui::SameLine();
    button("Save scene", {"save-scene", {}});
    ImGui::TextDisabled("new files in the folder it was started in");
    ImGui::Separator();
    button("Bookmark this view",
           {"bookmark", {"view " + std::to_string(state.scene->loaded.description.bookmarks.size() + 1)}});
    for (const CameraBookmark& bookmark : state.scene->loaded.description.bookmarks) {
        ImGui::PushID(bookmark.name.c_str());
        if (ImGui::SmallButton("x")) context.commands.push_back({"forget", {bookmark.name}});
        ImGui::SameLine();
        if (ImGui::Selectable(bookmark.name.c_str())) context.commands.push_back({"go", {bookmark.name}});
        ImGui::PopID();
    }
}

}  // namespace splice
