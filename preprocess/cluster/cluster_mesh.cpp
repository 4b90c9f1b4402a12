// Two-phase clustering: Ni 2005, algorithm 3.3, over Garland, Willmott and Heckbert's hierarchical face clustering
// (2001).
#include "preprocess/cluster/cluster_mesh.h"

#include "preprocess/cluster/cluster_graph.h"
#include "preprocess/cluster/cluster_metric.h"
#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/merge_heap.h"
#include "preprocess/cluster/patch_assembly.h"
#include "preprocess/cluster/roughness.h"
#include "preprocess/cluster/selection.h"
#include "preprocess/cluster/selection_auc.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace splice {
namespace {

// Thesis mode: what reproduces the published shares of triangles kept on the five published models.
constexpr double kThesisPhase1Cost = 0.1625;
constexpr double kThesisPhase2Cost = 1.8;
constexpr double kThesisMaxArea = 5.69;  // median triangle areas

// Geometric mode.
constexpr double kMaxAreaShare = 0.002;  // of the surface that is not made of larger triangles
constexpr double kMinMaxArea = 16;       // median triangle areas, so that coarse meshes still form patches
constexpr float kMaxSpread = 0.1745f;    // radians, 10 degrees
constexpr double kPhase2Cost = 0.9;

class Stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void check(const ClusterOptions& options) {
    const auto in = [](const std::optional<double>& x, double low, double high) {
        return !x || (*x >= low && *x <= high);
    };
    if (!in(options.triangle_share, 0, 1)) throw UsageError("triangle share must be from 0 to 1");
    if (!in(options.max_patch_area, std::numeric_limits<double>::min(), 1)) {
        throw UsageError("largest patch area must be above 0 and at most 1, a share of the surface");
    }
    for (const auto& cost : {options.phase1_cost, options.phase2_cost}) {
        if (cost && std::isnan(*cost)) throw UsageError("cost thresholds must be numbers");
    }
}

float median_area(const FaceGraph& faces) {
    std::vector<float> areas = faces.area;
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    return *middle;
}

double total_area(const FaceGraph& faces, double largest = std::numeric_limits<double>::infinity()) {
    double sum = 0;
    for (const float a : faces.area)
        sum += static_cast<double>(a) <= largest ? static_cast<double>(a) : 0.0;
    return sum;
}

/// A floor of two triangles must not decide how finely the statue on it is cut: triangles above the limit don't count.
float max_patch_area(const FaceGraph& faces, const ClusterOptions& options) {
    const double total = total_area(faces);
    const double median = static_cast<double>(median_area(faces));
    if (options.max_patch_area) return static_cast<float>(*options.max_patch_area * total);
    if (options.selection == Selection::kThesis) return static_cast<float>(kThesisMaxArea * median);
    const double counted = total_area(faces, kMaxAreaShare * total);
    return static_cast<float>(std::max(kMaxAreaShare * counted, kMinMaxArea * median));
}

std::uint32_t max_patch_faces(const FaceGraph& faces, const ClusterOptions& options) {
    // A hub that swallows a dense corner of a scene would cost O(n) a merge; a share needs patches that add up to it.
    const std::size_t limit = options.triangle_share ? std::max<std::size_t>(1, faces.size() / 100)
                                                     : std::max<std::size_t>(64, faces.size() / 128);
    return static_cast<std::uint32_t>(limit);
}

/// The clusters that triangles stay for, by area-weighted mean score, adding up to the share.
std::vector<std::uint8_t> surfels_by_share(const FaceGraph& faces, const ClusterGraph& graph,
                                           const std::vector<float>& scores, double share) {
    const std::vector<std::uint32_t> cluster = cluster_of_slots(graph);
    std::vector<double> score_sum(faces.size(), 0), area(faces.size(), 0);
    std::vector<std::uint32_t> count(faces.size(), 0);
    for (std::size_t s = 0; s < faces.size(); ++s) {
        score_sum[cluster[s]] += static_cast<double>(scores[s]) * static_cast<double>(faces.area[s]);
        area[cluster[s]] += static_cast<double>(faces.area[s]);
        ++count[cluster[s]];
    }
    std::vector<ScoredPatch> patches;
    for (std::uint32_t s = 0; s < faces.size(); ++s) {
        if (graph.alive(s)) patches.push_back({static_cast<float>(score_sum[s] / area[s]), s, count[s]});
    }
    const auto target = static_cast<std::uint64_t>(std::llround(share * static_cast<double>(faces.size())));
    std::vector<std::uint8_t> surfel(faces.size(), 1);
    for (const std::uint32_t slot : choose_flattest(std::move(patches), target))
        surfel[slot] = 0;
    return surfel;
}

}  // namespace

PatchSet cluster_mesh(const IndexedMesh& mesh, const ClusterOptions& options, const Progress& progress) {
    check(options);
    Stopwatch watch;
    const FaceGraph faces = build_face_graph(mesh);
    const std::size_t count = faces.size();
    const bool thesis = options.selection == Selection::kThesis;
    const float max_area = max_patch_area(faces, options);
    const auto tick = [&](std::size_t merges) {
        if (progress) progress("cluster", std::min(1.0, static_cast<double>(merges) / static_cast<double>(count)));
    };

    // The side of the threshold that each face is on.
    std::vector<std::uint8_t> surfel(count, options.representation == ForcedRepresentation::kSurfels);
    std::vector<float> scores;
    if (options.representation == ForcedRepresentation::kHybrid && (!thesis || options.triangle_share)) {
        scores = score_faces(faces, measure_roughness(mesh, faces));
        const float threshold = options.triangle_share ? score_at_share(scores, *options.triangle_share) : kRoughScore;
        for (std::size_t s = 0; s < count; ++s)
            surfel[s] = scores[s] > threshold;
    }
    const double seconds_prepared = watch.lap();

    ClusterGraph graph(faces);
    ShapeTable shapes(faces);
    const auto all = [](std::uint32_t) { return true; };
    if (thesis) {
        ThesisMetric metric(mesh, faces, shapes, max_area);
        contract(graph, metric, static_cast<float>(options.phase1_cost.value_or(kThesisPhase1Cost)), 1, all, tick);
    } else {
        FlatnessMetric metric(faces, shapes, surfel, {max_area, max_patch_faces(faces, options), kMaxSpread});
        contract(graph, metric, static_cast<float>(options.phase1_cost.value_or(kNever)), 1, all, tick);
    }
    const std::size_t merges = graph.tree().size();
    const double seconds_phase1 = watch.lap();

    const bool choose_all =
        thesis && !options.triangle_share && options.representation == ForcedRepresentation::kHybrid;
    if (options.triangle_share && options.representation == ForcedRepresentation::kHybrid) {
        surfel = surfels_by_share(faces, graph, scores, *options.triangle_share);
    }
    const double seconds_selection = watch.lap();

    const auto tick2 = [&](std::size_t n) { tick(merges + n); };
    if (options.representation != ForcedRepresentation::kTriangles) {
        SizeMetric metric(shapes, max_area, thesis ? kNever : max_area);
        const double cost = options.phase2_cost.value_or(thesis ? kThesisPhase2Cost : kPhase2Cost);
        contract(
            graph, metric, static_cast<float>(cost), 2, [&](std::uint32_t s) { return choose_all || surfel[s]; },
            tick2);
    }
    if (choose_all) {
        for (std::uint32_t s = 0; s < count; ++s)
            surfel[s] = graph.node(s) >= count + merges;
    }
    const double seconds_phase2 = watch.lap();

    const std::vector<std::uint32_t> cluster = cluster_of_slots(graph);
    PatchSet set = assemble_patches(mesh, faces, graph, cluster, surfel);
    std::vector<std::uint8_t> surfel_face(count);
    for (std::size_t s = 0; s < count; ++s)
        surfel_face[s] = surfel[cluster[s]];
    set.stats.selection_auc = measure_selection_auc(mesh, faces, surfel_face);
    set.stats.seconds_phase1 = seconds_phase1;
    set.stats.seconds_phase2 = seconds_phase2;
    set.stats.seconds_selection = seconds_prepared + seconds_selection + watch.lap();
    return set;
}

}  // namespace splice
