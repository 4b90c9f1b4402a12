// Two-phase clustering: Ni 2005, algorithm 3.3, over Garland, Willmott and Heckbert's hierarchical face clustering
// (2001).
#include "preprocess/cluster/cluster_mesh.h"

#include "preprocess/cluster/cluster_graph.h"
#include "preprocess/cluster/cluster_metric.h"
#include "preprocess/cluster/contract_blocks.h"
#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/merge_heap.h"
#include "preprocess/cluster/patch_assembly.h"
#include "preprocess/cluster/roughness.h"
#include "preprocess/cluster/selection.h"
#include "preprocess/cluster/selection_auc.h"
#include "preprocess/model_format/error.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

namespace splice {
namespace {

// Thesis mode: what reproduces the published shares of triangles kept on the five published models.
constexpr double kThesisPhase1Cost = 0.1625;
constexpr double kThesisPhase2Cost = 1.8;
constexpr double kThesisMaxArea = 5.69;  // median triangle areas

// Geometric mode.
constexpr double kPhase2Cost = 0.9;
constexpr double kMaxAreaShare = 0.002;  // of the surface that is not made of larger triangles
constexpr double kMinMaxArea = 16;       // median triangle areas, so that coarse meshes still form patches
constexpr float kMaxSpread = 0.1745f;    // radians, 10 degrees
constexpr float kCrumb = 0.125f;         // of the largest area
constexpr float kCrumbSlack = 1.25f;     // how far a patch may outgrow the largest area by taking in crumbs

// Clusters of kBlock at a time are contracted by themselves, up to each of these costs in turn; then all together.
constexpr std::uint32_t kBlock = 1u << 13;
constexpr float kBlockCosts[] = {0.0f, 0.25f};

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
    const auto within = [](const std::optional<double>& x, double low, double high) {
        return !x || (*x >= low && *x <= high);
    };
    if (!within(options.triangle_share, 0, 1)) throw UsageError("triangle share must be from 0 to 1");
    if (!within(options.max_patch_area, std::numeric_limits<double>::min(), 1)) {
        throw UsageError("largest patch area must be above 0 and at most 1, a share of the surface");
    }
    for (const auto& cost : {options.phase1_cost, options.phase2_cost}) {
        if (cost && std::isnan(*cost)) throw UsageError("cost thresholds must be numbers");
    }
}

/// The options, with every default resolved for this mesh.
struct Settings {
    bool thesis, hybrid, all_triangles, all_surfels;
    std::optional<double> share;
    float phase1_cost, phase2_cost;
    float max_area;  // unit-box units^2
    std::uint32_t max_faces;

    /// The surface is divided by score, not by what phase two touches.
    bool scored() const { return hybrid && (!thesis || share); }
};

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

double max_patch_area(const FaceGraph& faces, const ClusterOptions& options) {
    const double total = total_area(faces);
    const auto median = static_cast<double>(median_area(faces));
    if (options.max_patch_area) return *options.max_patch_area * total;
    if (options.selection == Selection::kThesis) return kThesisMaxArea * median;
    // A floor of two triangles must not decide how finely the statue on it is cut.
    return std::max(kMaxAreaShare * total_area(faces, kMaxAreaShare * total), kMinMaxArea * median);
}

Settings resolve(const ClusterOptions& options, const FaceGraph& faces) {
    Settings settings{};
    settings.thesis = options.selection == Selection::kThesis;
    settings.hybrid = options.representation == ForcedRepresentation::kHybrid;
    settings.all_triangles = options.representation == ForcedRepresentation::kTriangles;
    settings.all_surfels = options.representation == ForcedRepresentation::kSurfels;
    if (settings.hybrid) settings.share = options.triangle_share;
    settings.phase1_cost =
        static_cast<float>(options.phase1_cost.value_or(settings.thesis ? kThesisPhase1Cost : kNever));
    settings.phase2_cost =
        static_cast<float>(options.phase2_cost.value_or(settings.thesis ? kThesisPhase2Cost : kPhase2Cost));
    settings.max_area = static_cast<float>(max_patch_area(faces, options));
    // A hub that swallows a dense corner of a scene would cost O(n) a merge; a share needs patches that add up to it.
    const std::size_t max_faces =
        settings.share ? std::max<std::size_t>(1, faces.size() / 100) : std::max<std::size_t>(64, faces.size() / 128);
    settings.max_faces = static_cast<std::uint32_t>(max_faces);
    return settings;
}

/// What phase one starts from.
struct Surface {
    FaceGraph faces;
    Settings settings;
    std::vector<float> scores;  // by slot; empty if not scored
    float threshold = kRoughScore;
};

Surface measure_surface(const IndexedMesh& mesh, const ClusterOptions& options) {
    Surface surface;
    FaceRoughness roughness;
    std::vector<FaceGraph::Link> links;
    const std::vector<std::uint32_t> order = order_faces(mesh);
    // Kept apart: waiting for the last piece of a loop over faces, a thread would start on all of the links.
    tbb::parallel_invoke([&] { links = link_faces(mesh, order, find_face_adjacency(mesh, order)); },
                         [&] {
                             tbb::this_task_arena::isolate([&] {
                                 surface.faces = measure_faces(mesh, order);
                                 surface.settings = resolve(options, surface.faces);
                                 if (surface.settings.scored()) roughness = measure_roughness(mesh, surface.faces);
                             });
                         });
    surface.faces.links = std::move(links);
    if (surface.settings.scored()) surface.scores = score_faces(surface.faces, roughness);
    if (surface.settings.share) surface.threshold = score_at_share(surface.scores, *surface.settings.share);
    return surface;
}

/// The state of both phases.
struct Clusters {
    ClusterGraph graph;
    ClusterTable table;
    std::vector<std::uint8_t> surfel;         // by slot: on the rough side, to be drawn as surfels
    std::vector<std::uint32_t> slot_of_face;  // by slot of FaceGraph

    explicit Clusters(ClusterLevel level)
        : graph(std::move(level.nodes), level.links, level.slot_of_face.size(), std::move(level.tree)),
          table(std::move(level.clusters)),
          surfel(std::move(level.rough)),
          slot_of_face(std::move(level.slot_of_face)) {}
};

/// Every face a cluster.
ClusterLevel single_faces(const Surface& surface) {
    const FaceGraph& faces = surface.faces;
    ClusterLevel level;
    level.clusters = ClusterTable(faces, surface.scores).take();
    level.rough.assign(faces.size(), surface.settings.all_surfels);
    for (std::size_t s = 0; s < surface.scores.size(); ++s)
        level.rough[s] = surface.scores[s] > surface.threshold;
    level.nodes = faces.face_of_slot;
    level.links = faces.links;
    level.slot_of_face.resize(faces.size());
    std::iota(level.slot_of_face.begin(), level.slot_of_face.end(), 0u);
    return level;
}

bool everything(std::uint32_t) {
    return true;
}

template <class Tick>
Clusters run_phase_one(const IndexedMesh& mesh, const Surface& surface, const Tick& tick) {
    const Settings& settings = surface.settings;
    ClusterLevel level = single_faces(surface);
    if (settings.thesis) {
        Clusters clusters(std::move(level));
        ThesisMetric metric(mesh, surface.faces, clusters.table, settings.max_area);
        contract(clusters.graph, metric, settings.phase1_cost, 1, everything, tick);
        return clusters;
    }
    ClusterLimits limits{settings.max_area, settings.max_faces, kMaxSpread};
    for (const float cost : kBlockCosts) {
        if (level.nodes.size() <= kBlock) break;
        level = contract_blocks(level, limits, std::min(cost, settings.phase1_cost), kBlock);
        tick(level.tree.size());
    }
    Clusters clusters(std::move(level));
    FlatnessMetric flatness(clusters.table, clusters.surfel, limits);
    contract(clusters.graph, flatness, settings.phase1_cost, 1, everything, tick);
    limits.max_area *= kCrumbSlack;
    CrumbMetric crumbs(clusters.table, clusters.surfel, surface.threshold, limits, kCrumb * settings.max_area);
    contract(clusters.graph, crumbs, settings.phase1_cost, 1, everything, tick);
    return clusters;
}

/// The clusters that triangles stay for, by mean score, adding up to the share; the rest become surfels.
std::vector<std::uint8_t> surfels_by_share(const Clusters& clusters, double share) {
    const std::size_t slots = clusters.graph.slots();
    std::vector<ScoredPatch> patches;
    for (std::uint32_t s = 0; s < slots; ++s) {
        const Cluster& cluster = clusters.table[s];
        if (clusters.graph.alive(s)) patches.push_back({cluster.score_sum / cluster.shape.area, s, cluster.faces});
    }
    const auto target =
        static_cast<std::uint64_t>(std::llround(share * static_cast<double>(clusters.slot_of_face.size())));
    std::vector<std::uint8_t> surfel(slots, 1);
    for (const std::uint32_t slot : choose_flattest(std::move(patches), target))
        surfel[slot] = 0;
    return surfel;
}

template <class Tick>
void run_phase_two(const Settings& settings, Clusters& clusters, const Tick& tick) {
    ClusterGraph& graph = clusters.graph;
    const std::uint32_t before = graph.next_node();
    const bool mark_by_merging = settings.thesis && settings.hybrid && !settings.share;
    SizeMetric metric(clusters.table, settings.max_area, settings.thesis ? kNever : settings.max_area);
    contract(
        graph, metric, settings.phase2_cost, 2,
        [&](std::uint32_t s) { return mark_by_merging || clusters.surfel[s] != 0; }, tick);
    if (!mark_by_merging) return;
    for (std::uint32_t s = 0; s < graph.slots(); ++s)
        clusters.surfel[s] = graph.node(s) >= before;
}

}  // namespace

PatchSet cluster_mesh(const IndexedMesh& mesh, const ClusterOptions& options, const Progress& progress) {
    check(options);
    Surface surface = measure_surface(mesh, options);
    const Settings& settings = surface.settings;
    const auto tick = [&](std::size_t merged) {
        if (progress) progress("cluster", static_cast<double>(merged) / static_cast<double>(surface.faces.size()));
    };
    Clusters clusters = run_phase_one(mesh, surface, tick);
    if (settings.share) clusters.surfel = surfels_by_share(clusters, *settings.share);
    if (!settings.all_triangles) run_phase_two(settings, clusters, tick);
    if (progress) progress("cluster", 1.0);
    PatchSet set = assemble_patches(mesh, surface.faces, clusters.graph, clusters.slot_of_face, clusters.surfel);

    Stopwatch watch;
    if (settings.hybrid) set.stats.selection_auc = selection_auc(judge_places(mesh, surface.faces), set);
    set.stats.seconds_judge = watch.lap();
    return set;
}

}  // namespace splice
