#include "engine/capture/stats_json.h"

#include <nlohmann/json.hpp>

namespace splice {

namespace {

nlohmann::ordered_json json_of(const PassTime& pass) {
    nlohmann::ordered_json json{{"name", pass.name}, {"gpu_ms", pass.gpu_ms}};
    if (!pass.counts) return json;
    json["input_vertices"] = pass.counts->input_vertices;
    json["vertex_invocations"] = pass.counts->vertex_invocations;
    json["clipped_primitives"] = pass.counts->clipped_primitives;
    json["fragment_invocations"] = pass.counts->fragment_invocations;
    return json;
}

nlohmann::ordered_json json_of(const CutStats& cut) {
    nlohmann::ordered_json json;
    json["tau"] = cut.tau;
    if (cut.budget_ms) json["budget_ms"] = *cut.budget_ms;
    json["visited"] = cut.counts.visited;
    json["outside_frustum"] = cut.counts.outside_frustum;
    json["facing_away"] = cut.counts.facing_away;
    json["ellipses"] = cut.counts.ellipses;
    json["merged_surfels"] = cut.counts.merged_surfels;
    json["surfels"] = cut.counts.surfels;
    json["patches_by_triangles"] = cut.counts.patches_by_triangles;
    json["groups_by_triangles"] = cut.counts.groups_by_triangles;
    json["select_ms"] = cut.select_ms;
    json["gather_ms"] = cut.gather_ms;
    return json;
}

nlohmann::ordered_json json_of(const PageStats& pages) {
    nlohmann::ordered_json json;
    json["limit_bytes"] = pages.limit_bytes;
    json["resident_bytes"] = pages.resident_bytes;
    json["blocks_read"] = pages.blocks_read;
    json["missing_surfels"] = pages.missing_surfels;
    return json;
}

nlohmann::ordered_json json_of(const PatchCounts& patches) {
    return {{"drawn", patches.drawn},
            {"in_groups", patches.in_groups},
            {"in_cut", patches.in_cut},
            {"outside_frustum", patches.outside_frustum},
            {"facing_away", patches.facing_away},
            {"unwanted", patches.unwanted}};
}

nlohmann::ordered_json json_of(const SetupCounts& setup) {
    return {{"groups", setup.groups},
            {"certain_groups", setup.certain_groups},
            {"surfels", setup.surfels},
            {"culled_surfels", setup.culled_surfels}};
}

nlohmann::ordered_json json_of(const FrameStats& stats) {
    nlohmann::ordered_json json;
    json["device"] = stats.device;
    json["backend"] = name_of(stats.backend);
    json["drawn_by"] = nlohmann::ordered_json::object();
    for (const DrawnBy& share : stats.drawn_by)
        json["drawn_by"][std::string(name_of(share.backend))] = share.surfels;
    json["shading"] = name_of(stats.shading);
    json["antialias"] = stats.antialias;
    json["frame_ms"] = stats.frame_ms;
    json["passes"] = nlohmann::ordered_json::array();
    for (const PassTime& pass : stats.passes)
        json["passes"].push_back(json_of(pass));
    json["surfels_drawn"] = stats.surfels_drawn;
    if (stats.merged.splats > 0) json["merged"] = {{"splats", stats.merged.splats}, {"surfels", stats.merged.surfels}};
    if (stats.backend != Backend::kSprite) json["setup"] = json_of(stats.setup);
    json["triangles_drawn"] = stats.triangles_drawn;
    json["predicted_ms"] = stats.predicted_ms;
    json["costs_us"] = costs_json(stats.costs);
    json["costs_us"]["calibrated"] = stats.costs != kSoftwareCosts;
    json["patches"] = json_of(stats.patches);
    if (stats.cut.tau > 0 || stats.cut.budget_ms) json["cut"] = json_of(stats.cut);
    if (stats.pages.limit_bytes != 0) json["pages"] = json_of(stats.pages);
    json["resident"] = {{"surfel_bytes", stats.resident.surfels},
                        {"triangle_bytes", stats.resident.triangles},
                        {"device_bytes", stats.resident.device}};
    json["covered_pixels"] = stats.covered_pixels;
    json["overlap_mean"] = stats.overlap_mean;
    return json;
}

}  // namespace

nlohmann::ordered_json costs_json(const DrawCosts& costs) {
    return {{"frame", costs.frame},
            {"frame_pixel", costs.frame_pixel},
            {"triangle", costs.triangle},
            {"triangle_hit", costs.triangle_hit},
            {"triangle_pixel", costs.triangle_pixel},
            {"splat", costs.splat},
            {"splat_pixel", costs.splat_pixel}};
}

std::string stats_json(const std::vector<CapturedFile>& files) {
    nlohmann::ordered_json json = json_of(files.back().stats);
    if (files.size() > 1) {
        json["frames"] = nlohmann::ordered_json::array();
        for (const CapturedFile& file : files) {
            nlohmann::ordered_json frame = json_of(file.stats);
            frame["file"] = file.path;
            json["frames"].push_back(std::move(frame));
        }
    }
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace splice
