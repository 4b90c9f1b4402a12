// Surfels of all surfel patches, and how they are sampled.
#pragma once

#include "preprocess/cluster/patch_set.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/progress.h"

#include <array>
#include <optional>

namespace splice {

struct SurfelSample {
    Vec3f position;
    Vec3f normal;                               // unit, of the disk's plane
    float radius;                               // unit-box units
    float above, below;                         // how far the surface it stands for leaves its plane; at most radius
    float epsilon;                              // see format::Surfel
    std::uint32_t colour;                       // sRGB RGBA8, texture and material included, filtered over the disk
    std::array<std::int8_t, 5> shading_bend{};  // see format::Surfel
    std::uint16_t clip = kNoClip;               // surfel_clip.h
};

struct SurfelStats {
    std::uint64_t candidates = 0;  // before pruning
    std::uint64_t surfels = 0;
    // Over area-uniform random points of the surfel patches, if there are any:
    std::optional<double> coverage_mean;  // mean number of disks over a point
    double uncovered = 0;                 // share of the points under no disk (0 by construction)
    double seconds_sample = 0, seconds_prune = 0;
};

struct SurfelSet {
    std::vector<SurfelSample> surfels;       // grouped by patch, Morton order inside a patch
    std::vector<std::uint64_t> patch_begin;  // size patches + 1
    SurfelStats stats;
};

struct SamplingOptions {
    std::optional<double> thesis_c;  // set: the thesis's spacing h = (mean edge length of the patch) / c (3.3.2)
                                     // unset: spacing adapts to curvature and colour detail, see spacing_field.h
    double h_min = 1.0 / 4096;       // spacing limits, unit-box units; adaptive spacing goes down to 1/512 by itself
    double h_max = 1.0 / 48;
    double sagitta = 1.0 / 14000;       // how far the surface may bend away within a spacing, unit-box units
    double crease_spacing = 1.0 / 400;  // spacing at creases and borders, within the limits, unit-box units
    bool prune = true;  // false: every candidate is kept where it was found, at the radius it has before shrinking
};

/// Hole-free by construction: each point of each surfel patch lies under a disk of its own patch. Deterministic for any
/// thread count. Throws UsageError unless 0 < h_min <= h_max and thesis_c,
/// sagitta and crease_spacing > 0.
///
/// Why no point is bare. Each triangle is tiled by convex cells. Each cell is given to one site whose disk may cover it
/// (normals within 60 degrees of each other), a new site at the cell's own centre if there is none. A disk's radius is
/// at least the distance from its centre to every corner of its cells, measured along its plane and, apart, across it.
/// Projection to the plane is linear and a disk is convex, so with its corners the whole cell projects into the disk;
/// likewise the whole cell is no farther off the plane than its farthest corner. disk_covers() in coverage.h is that
/// condition, and measure_coverage() tests it at random points.
SurfelSet sample_patches(const IndexedMesh& mesh, const PatchSet& patches, const SamplingOptions& options,
                         const Progress& progress = {});

}  // namespace splice
