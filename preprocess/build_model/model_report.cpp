#include "preprocess/build_model/model_report.h"

#include "preprocess/build_model/counted.h"
#include "preprocess/model_format/section_layout.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <vector>

namespace splice {
namespace {

struct LevelTotal {
    std::uint64_t patches = 0, triangles = 0;
    float max_error = 0;
};

// What the tables add up to.
struct Totals {
    std::uint64_t triangle_patches = 0, surfel_patches = 0;
    double triangle_area = 0, surfel_area = 0;  // unit-box units^2
    std::vector<LevelTotal> levels;             // finest first

    explicit Totals(const ModelView& view) : levels(view.info->lod_levels) {
        for (const format::Patch& patch : view.patches) {
            const bool triangles = patch.representation == format::Representation::kTriangles;
            ++(triangles ? triangle_patches : surfel_patches);
            (triangles ? triangle_area : surfel_area) += static_cast<double>(patch.area);
            for (std::uint32_t i = 0; i < patch.lod_count; ++i) {
                const format::Lod& lod = view.lods[patch.first_lod + i];
                ++levels[i].patches;
                levels[i].triangles += lod.index_count / 3;
                levels[i].max_error = std::max(levels[i].max_error, lod.error);
            }
        }
    }
};

}  // namespace

std::string model_report_json(const ModelFile& file, const std::string& name) {
    const ModelView& view = file.view();
    const format::ModelInfo& info = *view.info;
    const Totals totals(view);
    nlohmann::ordered_json json;
    json["file"] = name;
    json["version"] = file.is_compressed() ? format::kCompressedVersion : format::kVersion;
    json["compressed"] = file.is_compressed();
    json["file_bytes"] = file.bytes().size();
    json["source"] = {{"vertices", info.source_vertices},
                      {"triangles", info.source_triangles},
                      {"scale", info.source_scale},
                      {"offset", info.source_offset}};
    json["bounds"] = {{"min", info.bounds_min}, {"max", info.bounds_max}};
    json["point_cloud"] = (info.flags & format::kPointCloud) != 0;
    json["two_sided"] = (info.flags & format::kTwoSided) != 0;
    json["has_colours"] = (info.flags & format::kHasColours) != 0;
    json["has_uvs"] = (info.flags & format::kHasUvs) != 0;
    json["drawn"] = {{"triangles", info.drawn_triangles}, {"surfels", view.surfel_count()}};
    json["patches"] = {{"triangle", totals.triangle_patches},
                       {"surfel", totals.surfel_patches},
                       {"triangle_area", totals.triangle_area},
                       {"surfel_area", totals.surfel_area}};
    json["surfel_radius"] = {{"median", info.median_surfel_radius}, {"max", info.max_surfel_radius}};
    json["levels"] = nlohmann::ordered_json::array();
    for (const LevelTotal& level : totals.levels)
        json["levels"].push_back(
            {{"patches", level.patches}, {"triangles", level.triangles}, {"max_error", level.max_error}});
    json["textures"] = nlohmann::ordered_json::array();
    for (const format::Texture& texture : view.textures)
        json["textures"].push_back(
            {{"width", texture.width}, {"height", texture.height}, {"mip_levels", texture.mip_levels}});
    json["sections"] = nlohmann::ordered_json::array();
    format::for_each_section(view,
                             [&]<typename T>(format::SectionKind, const char* title, std::span<const T> elements) {
                                 json["sections"].push_back({{"name", title},
                                                             {"count", elements.size()},
                                                             {"element_bytes", sizeof(T)},
                                                             {"bytes", elements.size_bytes()}});
                             });
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string model_report_text(const ModelFile& file, const std::string& name) {
    const ModelView& view = file.view();
    const format::ModelInfo& info = *view.info;
    const Totals totals(view);
    std::ostringstream text;
    text << name << ": ";
    if (file.is_compressed()) {
        text << "compressed model of format version " << format::kCompressedVersion;
    } else {
        text << "model of format version " << format::kVersion;
    }
    text << ", " << counted(file.bytes().size(), "byte") << ", intact\n";
    const bool cloud = (info.flags & format::kPointCloud) != 0;
    text << "source      ";
    if (cloud) {
        text << counted(info.source_vertices, "point");
    } else {
        text << counted(info.source_triangles, "triangle") << ", "
             << counted(info.source_vertices, "vertex", "vertices");
    }
    text << ", longest side " << info.source_scale << '\n';
    text << "surface     "
         << (cloud                                   ? "point cloud, drawn from both sides"
             : (info.flags & format::kTwoSided) != 0 ? "open, drawn from both sides"
                                                     : "closed, drawn from outside")
         << ((info.flags & format::kHasColours) == 0 ? ""
             : cloud                                 ? ", colours"
                                                     : ", vertex colours")
         << ((info.flags & format::kHasUvs) != 0 ? ", texture coordinates" : "") << '\n';
    const auto patches = [](std::uint64_t number) { return counted(number, "patch", "patches"); };
    text << "drawn       " << counted(info.drawn_triangles, "triangle") << " in " << patches(totals.triangle_patches)
         << ", " << counted(view.surfel_count(), "surfel") << " in " << patches(totals.surfel_patches) << '\n';
    if (view.surfel_count() != 0)
        text << "radius      median " << info.median_surfel_radius << ", largest " << info.max_surfel_radius
             << " of the longest side\n";
    for (std::size_t i = 0; i < totals.levels.size(); ++i)
        text << "level " << std::left << std::setw(6) << i << counted(totals.levels[i].triangles, "triangle") << " in "
             << patches(totals.levels[i].patches) << ", error at most " << totals.levels[i].max_error << '\n';
    for (const format::Texture& texture : view.textures)
        text << "texture     " << texture.width << " x " << texture.height << ", " << texture.mip_levels
             << (texture.mip_levels == 1 ? " mip level\n" : " mip levels\n");
    text << "\nsection           elements  bytes each        bytes\n";
    format::for_each_section(
        view, [&]<typename T>(format::SectionKind, const char* title, std::span<const T> elements) {
            text << std::left << std::setw(16) << title << std::right << std::setw(10) << elements.size()
                 << std::setw(12) << sizeof(T) << std::setw(13) << elements.size_bytes() << '\n';
        });
    return text.str();
}

}  // namespace splice
