// Surfels of all surfel patches, and how they are sampled.
#pragma once

#include "preprocess/cluster/patch_set.h"
#include "preprocess/progress.h"

#include <array>
#include <optional>

namespace splice {

struct SurfelSample {
    Vec3f position;
    Vec3f normal;                               // unit, of the disk's plane
    float radius;                               // unit-box units
    float epsilon;                              // see format::Surfel
    std::uint32_t colour;                       // sRGB RGBA8, texture and material included, filtered over the disk
    std::array<std::int8_t, 5> shading_bend{};  // see format::Surfel
};

struct SurfelStats {
    std::uint64_t candidates = 0;  // before pruning
    std::uint64_t surfels = 0;
    double coverage_mean = 0;  // mean number of disks over area-uniform random points of the surfel patches
    double uncovered = 0;      // share of those points under no disk (0 by construction)
    double seconds_sample = 0, seconds_prune = 0;
};

struct SurfelSet {
    std::vector<SurfelSample> surfels;       // grouped by patch, Morton order inside a patch
    std::vector<std::uint64_t> patch_begin;  // size patches + 1
    SurfelStats stats;
};

struct SamplingOptions {
    std::optional<double> thesis_c;  // set: the thesis's spacing h = (mean edge length of the patch) / c (3.3.2)
                                     // unset: spacing adapts to curvature and colour detail
    double h_min = 1.0 / 4096;       // spacing limits, unit-box units
    double h_max = 1.0 / 48;
    bool prune = true;
};

/// Hole-free by construction: each point of each surfel patch lies under a disk. Deterministic for any thread count.
SurfelSet sample_patches(const IndexedMesh& mesh, const PatchSet& patches, const SamplingOptions& options,
                         const Progress& progress = {});

}  // namespace splice
