#include "preprocess/build_model/bake_report.h"

#include "preprocess/build_model/counted.h"

#include <nlohmann/json.hpp>

#include <array>
#include <iomanip>
#include <sstream>
#include <utility>

namespace splice {
namespace {

template <typename Counts>
struct Count {
    const char* key;
    const char* one;   // how it reads when there is one
    const char* many;  // else
    std::uint64_t Counts::*count;
};

constexpr std::array kRepairCounts = {
    Count<RepairReport>{"welded_vertices", "vertex welded", "vertices welded", &RepairReport::welded_vertices},
    Count<RepairReport>{"isolated_vertices", "isolated vertex dropped", "isolated vertices dropped",
                        &RepairReport::isolated_vertices},
    Count<RepairReport>{"nonfinite_vertices", "vertex that is not finite", "vertices that are not finite",
                        &RepairReport::nonfinite_vertices},
    Count<RepairReport>{"invalid_polygons", "invalid polygon dropped", "invalid polygons dropped",
                        &RepairReport::invalid_polygons},
    Count<RepairReport>{"degenerate_triangles", "degenerate triangle dropped", "degenerate triangles dropped",
                        &RepairReport::degenerate_triangles},
    Count<RepairReport>{"flipped_caps", "collinear triangle given area", "collinear triangles given area",
                        &RepairReport::flipped_caps},
    Count<RepairReport>{"duplicate_triangles", "duplicate triangle dropped", "duplicate triangles dropped",
                        &RepairReport::duplicate_triangles},
    Count<RepairReport>{"flipped_triangles", "triangle turned to agree with its neighbours",
                        "triangles turned to agree with their neighbours", &RepairReport::flipped_triangles},
    Count<RepairReport>{"inverted_triangles", "triangle turned, the surface being inside out",
                        "triangles turned, the surface being inside out", &RepairReport::inverted_triangles},
    Count<RepairReport>{"computed_normals", "corner normal computed", "corner normals computed",
                        &RepairReport::computed_normals},
};

constexpr std::array kCloudCounts = {
    Count<CloudStats>{"nonfinite_points", "point that is not finite dropped", "points that are not finite dropped",
                      &CloudStats::nonfinite_points},
    Count<CloudStats>{"withheld_points", "withheld point dropped", "withheld points dropped",
                      &CloudStats::withheld_points},
    Count<CloudStats>{"duplicate_points", "duplicate point dropped", "duplicate points dropped",
                      &CloudStats::duplicate_points},
    Count<CloudStats>{"estimated_normals", "normal estimated", "normals estimated", &CloudStats::estimated_normals},
    Count<CloudStats>{"border_points", "point at a border", "points at a border", &CloudStats::border_points},
    Count<CloudStats>{"isolated_points", "isolated point", "isolated points", &CloudStats::isolated_points},
};

/// A line for each count that is not 0, the first one after `label`.
template <typename Counts, std::size_t N>
std::string listed(const char* label, const std::array<Count<Counts>, N>& counts, const Counts& of) {
    std::string text;
    for (const Count<Counts>& entry : counts)
        if (of.*entry.count != 0)
            text.append(std::exchange(label, "         ")).append(counted(of.*entry.count, entry.one, entry.many)) +=
                '\n';
    return text;
}

/// null where there is none.
nlohmann::ordered_json json_of(const std::optional<double>& figure) {
    return figure ? nlohmann::ordered_json(*figure) : nlohmann::ordered_json();
}

std::string cloud_json(const CloudStats& cloud, const BakeStats& stats, const BakeResult& result) {
    nlohmann::ordered_json json;
    json["input"] = {{"points", cloud.source_points}};
    for (const auto& entry : kCloudCounts)
        json["cloud"][entry.key] = cloud.*entry.count;
    json["cloud"]["components"] = cloud.components;
    json["cloud"]["plane_neighbours"] = cloud.plane_neighbours;
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
    for (const auto& entry : kRepairCounts)
        json["repair"][entry.key] = repair.*entry.count;
    json["repair"]["vertices"] = stats.vertices;
    json["repair"]["triangles"] = stats.triangles;
    json["patches"] = {{"triangle", stats.cluster.triangle_patches}, {"surfel", stats.cluster.surfel_patches}};
    json["output"] = {{"triangles", result.drawn_triangles},   {"surfels", result.surfels},
                      {"candidates", stats.surfel.candidates}, {"coverage_mean", json_of(stats.surfel.coverage_mean)},
                      {"uncovered", stats.surfel.uncovered},   {"file_bytes", result.file_bytes}};
    json["selection"] = {{"auc", json_of(stats.cluster.selection_auc)}};
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
        text << "input    " << counted(stats.cloud->source_points, "point") << '\n'
             << listed("cloud    ", kCloudCounts, *stats.cloud) << "output   " << counted(result.surfels, "surfel")
             << " in " << counted(stats.cluster.surfel_patches, "patch", "patches") << ", "
             << counted(result.file_bytes, "byte") << '\n'
             << took(stats, result);
        return text.str();
    }
    text << "input    " << counted(repair.source_triangles, "triangle") << ", "
         << counted(repair.source_vertices, "vertex", "vertices");
    if (repair.boundary_edges != 0) text << ", " << counted(repair.boundary_edges, "boundary edge");
    if (repair.nonmanifold_edges != 0) text << ", " << counted(repair.nonmanifold_edges, "non-manifold edge");
    text << '\n' << listed("repair   ", kRepairCounts, repair);
    text << "patches  " << grouped(stats.cluster.triangle_patches) << " of triangles, "
         << grouped(stats.cluster.surfel_patches) << " of surfels\n";
    text << "output   " << counted(result.drawn_triangles, "triangle") << ", " << counted(result.surfels, "surfel");
    if (stats.surfel.coverage_mean)
        text << " (" << std::fixed << std::setprecision(2) << *stats.surfel.coverage_mean << " disks over a point)";
    text << ", " << counted(result.file_bytes, "byte") << '\n';
    text << took(stats, result);
    return text.str();
}

}  // namespace splice
