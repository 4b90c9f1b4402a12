// Discrete restricted Voronoi diagrams and Lloyd's relaxation: Valette and Chassery 2004; disks' need: Wu and Kobbelt
// 2004.
#include "preprocess/surfel/voronoi_cover.h"

#include "preprocess/surfel/claim_cells.h"
#include "preprocess/surfel/surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace splice {
namespace {

constexpr float kDartDistance = 0.75f;   // of the spacing; jams at 0.81 spacings^2 a site, a hexagonal grid has 0.87
constexpr float kClaimDistance = 1.1f;   // of the spacing: no site owns cells whose centres are farther
constexpr float kRelaxDistance = 0.9f;   // the same while sites still move; the few cells beyond do not matter
constexpr float kRoundingSlack = 1e-6f;  // unit-box units; see cover_cells.cpp

// Calls visit(cell, squared distance) for the cells whose centre is within `distance` of a site that may cover them.
template <typename Visit>
void for_each_coverable(const CoverCells& cells, const CoverSite& site, float distance, Visit&& visit) {
    const SiteReach reach(site, distance);
    cells.for_each_range_near(site.position, distance, site.normal, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t i = first; i < end; ++i) {
            float distance2 = 0;
            if (reach.covers(cells.x[i], cells.y[i], cells.z[i], distance2)) visit(i, distance2);
        }
    });
}

CoverSite site_at(const IndexedMesh& mesh, const CellChunk& chunk, const Vec3f& near) {
    const Vec3f b = barycentric(mesh, chunk.triangle, near);
    return {point_at(mesh, chunk.triangle, b), plane_normal(mesh, chunk.triangle, b, chunk.normal, chunk.spacing),
            chunk.spacing, chunk.triangle, 0};
}

CellRange range_of(const CoverCells& cells, std::uint32_t first, std::uint32_t end) {
    return {&cells.x[first], &cells.y[first], &cells.z[first], end - first};
}

// The Voronoi diagram of the sites over the cells, distances in units of each site's spacing.
struct Diagram {
    std::vector<std::uint32_t> owner;
    std::vector<float> distance2;

    explicit Diagram(std::size_t cells) : owner(cells, kNoSite), distance2(cells, std::numeric_limits<float>::max()) {}

    void claim(const CoverCells& cells, const CoverSite& site, std::uint32_t index, float distance) {
        const SiteReach reach(site, distance * site.spacing);
        const float scale = 1 / (site.spacing * site.spacing);
        cells.for_each_range_near(
            site.position, distance * site.spacing, site.normal, [&](std::uint32_t first, std::uint32_t end) {
                claim_cells(reach, scale, index, range_of(cells, first, end), &distance2[first], &owner[first]);
            });
    }
};

Diagram diagram_of(const CoverCells& cells, const std::vector<CoverSite>& sites, float distance) {
    Diagram diagram(cells.size());
    for (std::uint32_t i = 0; i < sites.size(); ++i)
        diagram.claim(cells, sites[i], i, distance);
    return diagram;
}

}  // namespace

std::vector<CoverSite> throw_darts(const IndexedMesh& mesh, const CoverCells& cells) {
    const std::size_t n = cells.size();
    std::vector<CoverSite> sites;
    std::vector<std::uint32_t> blocked(n, 0);
    // Cells lie in Morton order, so stepping by the golden section visits them well spread. A step coprime to n meets
    // all.
    auto step = std::max<std::size_t>(1, static_cast<std::size_t>(0.6180339887 * static_cast<double>(n)));
    while (std::gcd(step, n) != 1)
        ++step;
    for (std::size_t k = 0, i = 0; k < n; ++k, i = (i + step) % n) {
        if (blocked[i] != 0) continue;
        sites.push_back(site_at(mesh, cells.chunks[cells.chunk_of[i]], cells.centre(i)));
        const CoverSite& site = sites.back();
        const float distance = kDartDistance * site.spacing;
        const SiteReach reach(site, distance);
        cells.for_each_range_near(site.position, distance, site.normal, [&](std::uint32_t first, std::uint32_t end) {
            mark_cells(reach, range_of(cells, first, end), &blocked[first]);
        });
    }
    return sites;
}

void relax_sites(const IndexedMesh& mesh, const CoverCells& cells, std::vector<CoverSite>& sites, int iterations) {
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const Diagram diagram = diagram_of(cells, sites, kRelaxDistance);
        std::vector<Vec3f> middle(sites.size(), Vec3f::Zero());
        std::vector<float> weight(sites.size(), 0.0f);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const auto s = diagram.owner[i];
            if (s == kNoSite) continue;
            middle[s] += cells.area[i] * cells.centre(i);
            weight[s] += cells.area[i];
        }
        std::vector<std::uint32_t> nearest(sites.size(), kNoSite);
        std::vector<float> nearest2(sites.size(), std::numeric_limits<float>::max());
        for (std::size_t s = 0; s < sites.size(); ++s) {
            if (weight[s] > 0) middle[s] /= weight[s];
        }
        for (std::uint32_t i = 0; i < cells.size(); ++i) {
            const auto s = diagram.owner[i];
            if (s == kNoSite || !(weight[s] > 0)) continue;
            const float d2 = (cells.centre(i) - middle[s]).squaredNorm();
            if (d2 < nearest2[s]) {
                nearest2[s] = d2;
                nearest[s] = i;
            }
        }
        for (std::size_t s = 0; s < sites.size(); ++s) {
            if (nearest[s] != kNoSite) sites[s] = site_at(mesh, cells.chunks[cells.chunk_of[nearest[s]]], middle[s]);
        }
    }
}

void prune_sites(const CoverCells& cells, std::vector<CoverSite>& sites, float reach) {
    const auto for_each_covered = [&](const CoverSite& site, auto&& visit) {
        const float radius = reach * site.spacing;
        for_each_coverable(cells, site, radius, [&](std::uint32_t cell, float distance2) {
            if (std::sqrt(distance2) + cells.margin[cell] <= radius) visit(cell);
        });
    };
    std::vector<std::uint32_t> count(cells.size(), 0);
    for (const auto& site : sites)
        for_each_covered(site, [&](std::uint32_t cell) { ++count[cell]; });

    // Redundancy: how often a site's cells are covered at least.
    std::vector<std::uint32_t> redundancy(sites.size(), 0), order(sites.size());
    for (std::size_t s = 0; s < sites.size(); ++s) {
        std::uint64_t sum = 0, own = 0;
        for_each_covered(sites[s], [&](std::uint32_t cell) {
            sum += count[cell];
            ++own;
        });
        redundancy[s] = own > 0 ? static_cast<std::uint32_t>(16 * sum / own) : 0xffffffffu;
    }
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return redundancy[a] > redundancy[b]; });
    std::vector<std::uint8_t> removed(sites.size(), 0);
    for (const auto s : order) {
        bool needed = false;
        for_each_covered(sites[s], [&](std::uint32_t cell) { needed |= count[cell] == 1; });
        if (needed) continue;
        removed[s] = 1;
        for_each_covered(sites[s], [&](std::uint32_t cell) { --count[cell]; });
    }
    std::size_t kept = 0;
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (removed[s] == 0) sites[kept++] = sites[s];
    }
    sites.resize(kept);
}

std::vector<std::uint32_t> close_cover(const IndexedMesh& mesh, const CoverCells& cells, std::vector<CoverSite>& sites,
                                       float overlap, float reach) {
    Diagram diagram = diagram_of(cells, sites, kClaimDistance);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (diagram.owner[i] != kNoSite) continue;
        sites.push_back(site_at(mesh, cells.chunks[cells.chunk_of[i]], cells.centre(i)));
        const auto index = static_cast<std::uint32_t>(sites.size() - 1);
        diagram.claim(cells, sites.back(), index, kClaimDistance);
        diagram.owner[i] = index;
    }
    std::vector<float> area(sites.size(), 0.0f);
    for (auto& site : sites)
        site.radius = site.above = site.below = 0;
    for (const auto& chunk : cells.chunks) {
        CoverCells::for_each_cell(chunk, [&](std::uint32_t cell, const std::array<Vec3f, 4>& corners) {
            auto& site = sites[diagram.owner[cell]];
            area[diagram.owner[cell]] += cells.area[cell];
            for (const auto& corner : corners) {
                const Vec3f d = corner - site.position;
                const float plane = d.dot(site.normal);
                const float tangential = std::sqrt(std::max(0.0f, d.squaredNorm() - plane * plane));
                site.radius = std::max(site.radius, std::max(tangential, std::abs(plane)) + kRoundingSlack);
                site.above = std::max(site.above, plane - kRoundingSlack);
                site.below = std::max(site.below, -plane - kRoundingSlack);
            }
        });
    }
    std::vector<std::uint32_t> renumbered(sites.size(), kNoSite);
    std::uint32_t kept = 0;
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (sites[s].radius == 0 && !(reach > 0)) continue;
        sites[s].radius = std::max({sites[s].radius, overlap * std::sqrt(area[s]), reach * sites[s].spacing});
        renumbered[s] = kept;
        sites[kept++] = sites[s];
    }
    sites.resize(kept);
    for (auto& owner : diagram.owner)
        owner = renumbered[owner];
    return std::move(diagram.owner);
}

}  // namespace splice
