#include "preprocess/build_model/bake_report.h"

#include <nlohmann/json.hpp>

#include <array>
#include <iomanip>
#include <sstream>
#include <utility>

namespace splice {
namespace {

struct RepairCount {
    const char* key;
    const char* text;
    std::uint64_t RepairReport::*count;
};

constexpr std::array kRepairCounts = {
    RepairCount{"welded_vertices", "vertices welded", &RepairReport::welded_vertices},
    RepairCount{"isolated_vertices", "isolated vertices dropped", &RepairReport::isolated_vertices},
    RepairCount{"nonfinite_vertices", "vertices that are not finite", &RepairReport::nonfinite_vertices},
    RepairCount{"invalid_polygons", "invalid polygons dropped", &RepairReport::invalid_polygons},
    RepairCount{"degenerate_triangles", "degenerate triangles dropped", &RepairReport::degenerate_triangles},
    RepairCount{"flipped_caps", "collinear triangles given area", &RepairReport::flipped_caps},
    RepairCount{"duplicate_triangles", "duplicate triangles dropped", &RepairReport::duplicate_triangles},
    RepairCount{"flipped_triangles", "triangles turned to agree with their neighbours",
                &RepairReport::flipped_triangles},
    RepairCount{"inverted_triangles", "triangles turned, the surface being inside out",
                &RepairReport::inverted_triangles},
    RepairCount{"computed_normals", "corner normals computed", &RepairReport::computed_normals},
};

struct CloudCount {
    const char* key;
    const char* text;
    std::uint64_t CloudStats::*count;
};

constexpr std::array kCloudCounts = {
    CloudCount{"nonfinite_points", "points that are not finite dropped", &CloudStats::nonfinite_points},
    CloudCount{"withheld_points", "withheld points dropped", &CloudStats::withheld_points},
    CloudCount{"duplicate_points", "duplicate points dropped", &CloudStats::duplicate_points},
    CloudCount{"estimated_normals", "normals estimated", &CloudStats::estimated_normals},
    CloudCount{"border_points", "points at a border", &CloudStats::border_points},
    CloudCount{"isolated_points", "isolated points", &CloudStats::isolated_points},
};

std::string cloud_json(const CloudStats& cloud, const BakeStats& stats, const BakeResult& result) {
    nlohmann::ordered_json json;
    json["input"] = {{"points", cloud.source_points}};
    for (const CloudCount& entry : kCloudCounts)
        json["cloud"][entry.key] = cloud.*entry.count;
    json["cloud"]["components"] = cloud.components;
    json["patches"] = {{"triangle", 0}, {"surfel", stats.cluster.surfel_patches}};
    json["output"] = {{"triangles", 0}, {"surfels", result.surfels}, {"file_bytes", result.file_bytes}};
    json["seconds"] = {{"read", stats.seconds_read},
                       {"sort", cloud.seconds_sort},
                       {"surface", cloud.seconds_surface},
                       {"orient", cloud.seconds_orient},
                       {"assemble", stats.seconds_assemble},
                       {"write", result.seconds_write},
                       {"total", stats.seconds_total + result.seconds_write}};
    json["peak_rss_bytes"] = result.peak_rss_bytes;
    json["warnings"] = stats.warnings;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

// 1234567 -> "1,234,567"
std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
        digits.insert(static_cast<std::size_t>(place), 1, ',');
    return digits;
}

std::string took(const BakeStats& stats, const BakeResult& result) {
    std::ostringstream text;
    text << "took     " << std::fixed << std::setprecision(2) << stats.seconds_total + result.seconds_write << " s, "
         << grouped(result.peak_rss_bytes / 1'000'000) << " MB\n";
    return text.str();
}

}  // namespace

std::string stats_json(const BakeStats& stats, const BakeResult& result) {
    if (stats.cloud) return cloud_json(*stats.cloud, stats, result);
    nlohmann::ordered_json json;
    const RepairReport& repair = stats.repair;
    json["input"] = {{"vertices", repair.source_vertices},
                     {"polygons", repair.source_polygons},
                     {"triangles", repair.source_triangles},
                     {"boundary_edges", repair.boundary_edges},
                     {"nonmanifold_edges", repair.nonmanifold_edges}};
    for (const RepairCount& entry : kRepairCounts)
        json["repair"][entry.key] = repair.*entry.count;
    json["repair"]["vertices"] = stats.vertices;
    json["repair"]["triangles"] = stats.triangles;
    json["patches"] = {{"triangle", stats.cluster.triangle_patches}, {"surfel", stats.cluster.surfel_patches}};
    json["output"] = {{"triangles", result.drawn_triangles},   {"surfels", result.surfels},
                      {"candidates", stats.surfel.candidates}, {"coverage_mean", stats.surfel.coverage_mean},
                      {"uncovered", stats.surfel.uncovered},   {"file_bytes", result.file_bytes}};
    json["selection"] = {{"auc", stats.cluster.selection_auc}};
    json["seconds"] = {{"read", stats.seconds_read},         {"repair", stats.seconds_repair},
                       {"cluster", stats.seconds_cluster},   {"judge", stats.cluster.seconds_judge},
                       {"simplify", stats.seconds_simplify}, {"sample", stats.seconds_sample},
                       {"prune", stats.seconds_prune},       {"assemble", stats.seconds_assemble},
                       {"write", result.seconds_write},      {"total", stats.seconds_total + result.seconds_write}};
    json["peak_rss_bytes"] = result.peak_rss_bytes;
    json["warnings"] = stats.warnings;
    // File names in warnings need not be UTF-8.
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string summary(const BakeStats& stats, const BakeResult& result) {
    std::ostringstream text;
    const RepairReport& repair = stats.repair;
    if (stats.cloud) {
        text << "input    " << grouped(stats.cloud->source_points) << " points\n";
        const char* label = "cloud    ";
        for (const CloudCount& entry : kCloudCounts) {
            if ((*stats.cloud).*entry.count == 0) continue;
            text << std::exchange(label, "         ") << grouped((*stats.cloud).*entry.count) << ' ' << entry.text
                 << '\n';
        }
        text << "output   " << grouped(result.surfels) << " surfels in " << grouped(stats.cluster.surfel_patches)
             << " patches, " << grouped(result.file_bytes) << " bytes\n";
        text << took(stats, result);
        return text.str();
    }
    text << "input    " << grouped(repair.source_triangles) << " triangles, " << grouped(repair.source_vertices)
         << " vertices";
    if (repair.boundary_edges != 0) text << ", " << grouped(repair.boundary_edges) << " boundary edges";
    if (repair.nonmanifold_edges != 0) text << ", " << grouped(repair.nonmanifold_edges) << " non-manifold edges";
    text << '\n';
    const char* label = "repair   ";
    for (const RepairCount& entry : kRepairCounts) {
        if (repair.*entry.count == 0) continue;
        text << std::exchange(label, "         ") << grouped(repair.*entry.count) << ' ' << entry.text << '\n';
    }
    text << "patches  " << grouped(stats.cluster.triangle_patches) << " of triangles, "
         << grouped(stats.cluster.surfel_patches) << " of surfels\n";
    text << "output   " << grouped(result.drawn_triangles) << " triangles, " << grouped(result.surfels) << " surfels";
    if (result.surfels != 0)
        text << " (" << std::fixed << std::setprecision(2) << stats.surfel.coverage_mean << " disks over a point)";
    text << ", " << grouped(result.file_bytes) << " bytes\n";
    text << took(stats, result);
    return text.str();
}

}  // namespace splice
