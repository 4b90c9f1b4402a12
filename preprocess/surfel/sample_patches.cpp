// Sampling of surfel patches (Ni 2005, 3.3.2, 4.2) with the defects it admits removed: redundant disks (5.2) and
// missing corners (figure 4.9).
#include "preprocess/model_format/error.h"
#include "preprocess/surfel/coverage.h"
#include "preprocess/surfel/disk_clip.h"
#include "preprocess/surfel/grid_sampling.h"
#include "preprocess/surfel/morton.h"
#include "preprocess/surfel/shading_bend.h"
#include "preprocess/surfel/spacing_field.h"
#include "preprocess/surfel/surface_point.h"
#include "preprocess/surfel/surfel_colour.h"
#include "preprocess/surfel/surfel_set.h"
#include "preprocess/surfel/voronoi_cover.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace splice {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float kReach = 0.8f;  // radius of a disk before shrinking, in spacings: 2.3 disks a point on a hexagonal grid
constexpr float kOverlap = 0.86f;  // the same radius in units of the square root of a disk's share of the surface
constexpr float kCellSize = 0.2f;  // of the spacing: a quarter of that radius
constexpr int kRelaxations = 8;
constexpr std::size_t kTestPoints = 50000;
constexpr std::uint64_t kTestSeed = 2005;

struct SampledPatch {
    std::vector<SurfelSample> surfels;
    std::uint64_t candidates = 0;
    double seconds = 0, seconds_prune = 0;  // of one thread
};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Inputs {
    const IndexedMesh& mesh;
    const SamplingOptions& options;
    const SpacingField* field;  // null: the thesis's spacing
    const SurfaceColour& colour;
    const SmoothNeighbours& neighbours;
};

std::vector<CoverSite> thesis_sites(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, float h,
                                    float spacing) {
    std::vector<CoverSite> sites;
    for (const auto& sample : sample_on_grids(mesh, triangles, h)) {
        const Vec3f face = face_normal(mesh, sample.triangle);
        const Vec3f b = barycentric(mesh, sample.triangle, sample.position);
        sites.push_back(
            {sample.position, plane_normal(mesh, sample.triangle, b, face, spacing), spacing, sample.triangle, 0});
    }
    return sites;
}

void add_colours(const Inputs& in, const CoverCells& cells, const std::vector<std::uint32_t>& owner,
                 std::uint32_t material, std::vector<SurfelSample>& surfels, const std::vector<CoverSite>& sites) {
    if (!in.colour.varies(material)) {
        for (std::size_t s = 0; s < sites.size(); ++s) {
            surfels[s].colour = SurfaceColour::encode(in.colour.at(sites[s].triangle, Vec3f::Constant(1.0f / 3), 0));
        }
        return;
    }
    std::vector<LinearColour> sum(sites.size(), LinearColour::Zero());
    std::vector<float> weight(sites.size(), 0.0f);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto triangle = cells.chunks[cells.chunk_of[i]].triangle;
        const float area = std::max(cells.area[i], 1e-20f);
        sum[owner[i]] +=
            area * in.colour.at(triangle, barycentric(in.mesh, triangle, cells.centre(i)), std::sqrt(area));
        weight[owner[i]] += area;
    }
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (weight[s] > 0) {
            surfels[s].colour = SurfaceColour::encode(sum[s] / weight[s]);
        } else {  // kept although its neighbours own its surface
            const Vec3f b = barycentric(in.mesh, sites[s].triangle, sites[s].position);
            surfels[s].colour = SurfaceColour::encode(in.colour.at(sites[s].triangle, b, surfels[s].radius));
        }
    }
}

void sort_by_morton_code(std::vector<SurfelSample>& surfels) {
    if (surfels.empty()) return;
    Vec3f low = surfels[0].position, high = low;
    for (const auto& s : surfels) {
        low = low.cwiseMin(s.position);
        high = high.cwiseMax(s.position);
    }
    const float extent = (high - low).maxCoeff();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order(surfels.size());
    for (std::uint32_t i = 0; i < surfels.size(); ++i)
        order[i] = {morton_code(surfels[i].position, low, extent), i};
    std::sort(order.begin(), order.end());
    std::vector<SurfelSample> sorted;
    sorted.reserve(surfels.size());
    for (const auto& [code, i] : order)
        sorted.push_back(surfels[i]);
    surfels = std::move(sorted);
}

SampledPatch sample_patch(const Inputs& in, std::span<const std::uint32_t> triangles, std::uint32_t material) {
    if (triangles.empty()) return {};
    const auto start = Clock::now();
    float h = 0;  // of the thesis; there the radius before shrinking is sqrt(3) h
    if (in.field == nullptr) {
        h = thesis_spacing(in.mesh, triangles, *in.options.thesis_c, in.options.h_min, in.options.h_max);
    }
    const float thesis_spacing_of_disks = std::sqrt(3.0f) * h / kReach;
    const CoverCells cells(
        in.mesh, triangles,
        [&](std::uint32_t t, const Vec3f& p) {
            return in.field != nullptr ? in.field->at(t, p) : thesis_spacing_of_disks;
        },
        kCellSize);

    std::vector<CoverSite> sites = in.field != nullptr ? throw_darts(in.mesh, cells)
                                                       : thesis_sites(in.mesh, triangles, h, thesis_spacing_of_disks);
    SampledPatch result;
    result.candidates = sites.size();
    const auto pruning = Clock::now();
    if (in.options.prune) {
        if (in.field == nullptr) prune_sites(cells, sites, kReach);
        relax_sites(in.mesh, cells, sites, in.field != nullptr ? kRelaxations : 0);
    }
    const std::vector<std::uint32_t> owner =
        close_cover(in.mesh, cells, sites, kOverlap, in.options.prune ? 0.0f : kReach);
    result.seconds_prune = seconds_since(pruning);
    result.surfels.reserve(sites.size());
    for (const auto& site : sites)
        result.surfels.push_back(
            {site.position, site.normal, site.radius, site.above, site.below, kReach * site.spacing, kWhite});
    const std::vector<ShadingBend> bends = fit_shading_bends(in.mesh, cells, sites);
    for (std::size_t s = 0; s < sites.size(); ++s)
        result.surfels[s].shading_bend = encode_shading_bend(bends[s], result.surfels[s].radius);
    const std::vector<std::uint16_t> clips = fit_disk_clips(in.mesh, in.neighbours, cells, sites, owner);
    for (std::size_t s = 0; s < sites.size(); ++s)
        result.surfels[s].clip = clips[s];
    add_colours(in, cells, owner, material, result.surfels, sites);
    sort_by_morton_code(result.surfels);
    result.seconds = seconds_since(start);
    return result;
}

}  // namespace

SurfelSet sample_patches(const IndexedMesh& mesh, const PatchSet& patches, const SamplingOptions& options,
                         const Progress& progress) {
    if (!(options.h_min > 0) || !(options.h_max >= options.h_min))
        throw UsageError("surfel spacing needs 0 < h-min <= h-max");
    if (!(options.sagitta > 0) || !(options.crease_spacing > 0))
        throw UsageError("surfel spacing needs a sagitta and a crease spacing above 0");
    if (options.thesis_c && !(*options.thesis_c > 0)) throw UsageError("the sampling constant C must be above 0");
    const auto start = Clock::now();
    const SmoothNeighbours neighbours = find_smooth_neighbours(mesh);
    const SurfaceColour colour(mesh);
    std::optional<SpacingField> field;
    if (!options.thesis_c) field.emplace(mesh, neighbours, colour, options);
    const Inputs inputs{mesh, options, field ? &*field : nullptr, colour, neighbours};
    if (progress) progress("sample", 0.1);

    std::vector<SampledPatch> sampled(patches.patches.size());
    tbb::parallel_for(std::size_t{0}, sampled.size(), [&](std::size_t p) {
        if (patches.patches[p].representation != format::Representation::kSurfels) return;
        const std::span<const std::uint32_t> all(patches.patch_triangles);
        sampled[p] = sample_patch(
            inputs, all.subspan(patches.patch_begin[p], patches.patch_begin[p + 1] - patches.patch_begin[p]),
            patches.patches[p].material);
    });

    SurfelSet set;
    set.patch_begin.push_back(0);
    std::size_t total = 0;
    double seconds = 0, seconds_prune = 0;
    for (const auto& patch : sampled)
        total += patch.surfels.size();
    set.surfels.reserve(total);
    for (auto& patch : sampled) {
        set.surfels.insert(set.surfels.end(), patch.surfels.begin(), patch.surfels.end());
        set.patch_begin.push_back(set.surfels.size());
        set.stats.candidates += patch.candidates;
        seconds += patch.seconds;
        seconds_prune += patch.seconds_prune;
        patch = {};
    }
    set.stats.surfels = set.surfels.size();
    // Patches run side by side: the stage's time is shared out as the threads' time was.
    const double elapsed = seconds_since(start);
    set.stats.seconds_prune = seconds > 0 ? elapsed * seconds_prune / seconds : 0;
    set.stats.seconds_sample = elapsed - set.stats.seconds_prune;
    if (const auto coverage = measure_coverage(mesh, patches, set, kTestPoints, kTestSeed)) {
        set.stats.coverage_mean = coverage->mean;
        set.stats.uncovered = coverage->uncovered;
    }
    if (progress) progress("sample", 1.0);
    return set;
}

}  // namespace splice
