// Each patch on its own, in parallel; patch_simplifier.cpp has the algorithm.
#include "preprocess/simplify/simplify_patches.h"

#include "preprocess/simplify/patch_simplifier.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <thread>

namespace splice {
namespace {

// Nonzero for positions where triangles of several patches meet.
std::vector<std::uint8_t> find_patch_borders(const IndexedMesh& mesh, const PatchSet& patches) {
    constexpr std::uint32_t unseen = 0xffffffffu;
    std::vector<std::uint32_t> patch_of(mesh.positions.size(), unseen);
    std::vector<std::uint8_t> on_border(mesh.positions.size(), 0);
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        const std::uint32_t patch = patches.triangle_patch[triangle];
        for (const std::uint32_t position : mesh.triangles[triangle]) {
            if (patch_of[position] == unseen) patch_of[position] = patch;
            if (patch_of[position] != patch) on_border[position] = 1;
        }
    }
    return on_border;
}

std::span<const std::uint32_t> triangles_of(const PatchSet& patches, std::size_t patch) {
    return std::span(patches.patch_triangles)
        .subspan(patches.patch_begin[patch], patches.patch_begin[patch + 1] - patches.patch_begin[patch]);
}

std::vector<PatchSimplifier::CoarserLevels> simplify_all(const IndexedMesh& mesh, const RenderVertices& vertices,
                                                         const PatchSet& patches, const SimplifyOptions& options,
                                                         const Progress& progress) {
    const std::vector<std::uint8_t> on_border = find_patch_borders(mesh, patches);
    const std::size_t count = patches.patches.size();
    std::vector<PatchSimplifier::CoarserLevels> result(count);
    tbb::enumerable_thread_specific<PatchSimplifier> simplifiers(
        [&] { return PatchSimplifier(mesh, vertices, on_border); });
    std::atomic<std::size_t> triangles_done = 0;
    const std::thread::id caller = std::this_thread::get_id();
    double reported = 0;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t patch) {
        const auto triangles = triangles_of(patches, patch);
        result[patch] = simplifiers.local().simplify(triangles, options);
        const std::size_t done = triangles_done += triangles.size();
        // Progress is owed to the calling thread alone, which does its share of the patches.
        if (!progress || std::this_thread::get_id() != caller) return;
        const double fraction = static_cast<double>(done) / static_cast<double>(mesh.triangles.size());
        if (fraction < reported + 0.01) return;
        reported = fraction;
        progress("simplify", fraction);
    });
    return result;
}

}  // namespace

PatchLods simplify_patches(const IndexedMesh& mesh, const RenderVertices& vertices, const PatchSet& patches,
                           const SimplifyOptions& options, const Progress& progress) {
    const auto coarser = simplify_all(mesh, vertices, patches, options, progress);
    PatchLods lods;
    std::size_t index_count = 3 * mesh.triangles.size();
    for (const auto& patch : coarser)
        index_count += patch.indices.size();
    lods.indices.reserve(index_count);
    for (const std::uint32_t triangle : patches.patch_triangles)
        for (std::size_t k = 0; k < 3; ++k)
            lods.indices.push_back(vertices.indices[std::size_t{3} * triangle + k]);

    lods.patch_begin.push_back(0);
    for (std::size_t patch = 0; patch < coarser.size(); ++patch) {
        const std::uint64_t finest = std::uint64_t{3} * patches.patch_begin[patch];
        lods.levels.push_back({finest, static_cast<std::uint32_t>(3 * triangles_of(patches, patch).size()), 0.0f});
        for (PatchLods::Level level : coarser[patch].levels) {
            level.first_index += lods.indices.size();
            lods.levels.push_back(level);
        }
        lods.indices.insert(lods.indices.end(), coarser[patch].indices.begin(), coarser[patch].indices.end());
        lods.patch_begin.push_back(static_cast<std::uint32_t>(lods.levels.size()));
    }
    return lods;
}

}  // namespace splice
