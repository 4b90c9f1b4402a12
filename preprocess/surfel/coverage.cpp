// Points are sorted into a grid and every disk looks up the points near it.
#include "preprocess/surfel/coverage.h"

#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/surface_point.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

namespace splice {
namespace {

constexpr int kGrid = 128;  // cells along a side of the unit box

struct TestPoint {
    Vec3f position, normal;
    std::uint32_t patch;
    std::uint32_t cell;
};

// Sequence of Steele, Lea and Flood 2014 (SplitMix64).
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double next() {  // [0, 1)
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
    }

  private:
    std::uint64_t state_;
};

int grid_coordinate(float x) {
    return std::clamp(static_cast<int>(std::floor((x + 0.5f) * kGrid)), 0, kGrid - 1);
}

std::vector<TestPoint> random_points(const IndexedMesh& mesh, const PatchSet& patches, std::size_t count,
                                     std::uint64_t seed) {
    std::vector<double> area_until;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> triangles;  // and their patches
    double area = 0;
    for (std::uint32_t p = 0; p < patches.patches.size(); ++p) {
        if (patches.patches[p].representation != format::Representation::kSurfels) continue;
        for (auto i = patches.patch_begin[p]; i < patches.patch_begin[p + 1]; ++i) {
            const auto t = patches.patch_triangles[i];
            const auto& v = mesh.triangles[t];
            const Vec3f e1 = mesh.positions[v[1]] - mesh.positions[v[0]],
                        e2 = mesh.positions[v[2]] - mesh.positions[v[0]];
            area += e1.cross(e2).norm();
            area_until.push_back(area);
            triangles.emplace_back(t, p);
        }
    }
    std::vector<TestPoint> points;
    if (!(area > 0)) return points;
    points.reserve(count);
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at =
            std::upper_bound(area_until.begin(), area_until.end(), random.next() * area) - area_until.begin();
        const auto [t, patch] = triangles[std::min(static_cast<std::size_t>(at), triangles.size() - 1)];
        const auto& v = mesh.triangles[t];
        const auto root = static_cast<float>(std::sqrt(random.next())), s = static_cast<float>(random.next());
        const Vec3f a = mesh.positions[v[0]], e1 = mesh.positions[v[1]] - a, e2 = mesh.positions[v[2]] - a;
        const Vec3f position = a + root * ((1 - s) * e1 + s * e2);
        const Vec3f normal = face_normal(mesh, t);
        const int cell = (grid_coordinate(position.z()) * kGrid + grid_coordinate(position.y())) * kGrid +
                         grid_coordinate(position.x());
        points.push_back({position, normal, patch, static_cast<std::uint32_t>(cell)});
    }
    std::stable_sort(points.begin(), points.end(),
                     [](const TestPoint& a, const TestPoint& b) { return a.cell < b.cell; });
    return points;
}

}  // namespace

namespace {

bool beyond_clip(const SurfelSample& surfel, const Vec3f& d) {
    const Vec3f& n = surfel.normal;
    const auto stored = decode_octahedral(encode_octahedral(n.x(), n.y(), n.z()));
    const auto [s, t] = tangents_of(stored);
    const SurfelClip clip = decode_clip(surfel.clip);
    const float u = d.dot(Vec3f(s[0], s[1], s[2])), v = d.dot(Vec3f(t[0], t[1], t[2]));
    return clip.x * u + clip.y * v > clip.offset * surfel.radius;
}

}  // namespace

bool disk_covers(const SurfelSample& surfel, const Vec3f& point, const Vec3f& face_normal) {
    const Vec3f d = point - surfel.position;
    const float plane = d.dot(surfel.normal), radius2 = surfel.radius * surfel.radius;
    if (surfel.clip != kNoClip && beyond_clip(surfel, d)) return false;
    return d.squaredNorm() - plane * plane <= radius2 && plane * plane <= radius2 &&
           surfel.normal.dot(face_normal) >= 0.5f;
}

std::optional<Coverage> measure_coverage(const IndexedMesh& mesh, const PatchSet& patches, const SurfelSet& surfels,
                                         std::size_t count, std::uint64_t seed) {
    const std::vector<TestPoint> points = random_points(mesh, patches, count, seed);
    if (points.empty()) return std::nullopt;
    std::vector<std::uint32_t> row_begin(static_cast<std::size_t>(kGrid) * kGrid + 1,
                                         0);  // first point of each row of cells
    for (const auto& point : points)
        ++row_begin[point.cell / kGrid + 1];
    for (std::size_t i = 0; i + 1 < row_begin.size(); ++i)
        row_begin[i + 1] += row_begin[i];

    std::vector<std::atomic<std::uint8_t>> covered(points.size());
    std::atomic<std::uint64_t> disks = 0;
    tbb::parallel_for(std::size_t{0}, patches.patches.size(), [&](std::size_t patch) {
        std::uint64_t hits = 0;
        for (auto s = surfels.patch_begin[patch]; s < surfels.patch_begin[patch + 1]; ++s) {
            const SurfelSample& surfel = surfels.surfels[s];
            const float reach = 1.4143f * surfel.radius;
            const Vec3f& c = surfel.position;
            const int x0 = grid_coordinate(c.x() - reach), x1 = grid_coordinate(c.x() + reach);
            for (int z = grid_coordinate(c.z() - reach); z <= grid_coordinate(c.z() + reach); ++z) {
                for (int y = grid_coordinate(c.y() - reach); y <= grid_coordinate(c.y() + reach); ++y) {
                    const auto row = static_cast<std::size_t>(z * kGrid + y);
                    for (auto i = row_begin[row]; i < row_begin[row + 1]; ++i) {
                        const int x = static_cast<int>(points[i].cell % kGrid);
                        if (x < x0 || x > x1 || !disk_covers(surfel, points[i].position, points[i].normal)) continue;
                        ++hits;
                        if (points[i].patch == patch) covered[i].store(1, std::memory_order_relaxed);
                    }
                }
            }
        }
        disks.fetch_add(hits, std::memory_order_relaxed);
    });
    const auto bare = std::count_if(covered.begin(), covered.end(), [](const auto& c) { return c.load() == 0; });
    const auto n = static_cast<double>(points.size());
    return Coverage{static_cast<double>(disks.load()) / n, static_cast<double>(bare) / n};
}

}  // namespace splice
