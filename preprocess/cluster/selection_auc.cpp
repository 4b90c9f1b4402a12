#include "preprocess/cluster/selection_auc.h"

#include "preprocess/cluster/roughness.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

namespace splice {
namespace {

constexpr double kNeighbours = 40;  // points on a disk of one radius
constexpr double kMinPoints = 2'000;
constexpr double kMaxPoints = 80'000;
constexpr std::size_t kEvery = 4;  // each fourth point is compared
constexpr std::size_t kSide = 51;  // blocks of one radius across the unit box, one to spare

struct Point {
    Vec3f position;
    std::uint32_t slot;
};

/// Points at equal steps of area along the face order, each placed in its face by the R2 sequence (Roberts 2018).
std::vector<Point> spread_points(const IndexedMesh& mesh, const FaceGraph& faces) {
    double total = 0;
    for (const float a : faces.area)
        total += static_cast<double>(a);
    constexpr double kDisk = std::numbers::pi * double{kRoughnessRadius} * double{kRoughnessRadius};
    const auto count = static_cast<std::size_t>(std::clamp(kNeighbours * total / kDisk, kMinPoints, kMaxPoints));
    const double step = total / static_cast<double>(count);
    std::vector<Point> points;
    points.reserve(count);
    double passed = 0;
    for (std::size_t s = 0; s < faces.size(); ++s) {
        passed += static_cast<double>(faces.area[s]);
        while (points.size() < count && (static_cast<double>(points.size()) + 0.5) * step < passed) {
            const auto i = static_cast<double>(points.size());
            double u = fraction(0.5 + i * 0.7548776662466927), v = fraction(0.5 + i * 0.5698402909980532);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const auto [a, b, c] = faces.corners(mesh, s);
            points.push_back(
                {a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a), static_cast<std::uint32_t>(s)});
        }
    }
    return points;
}

/// The points again, in blocks of one radius, x fastest: three neighbours in x are one run.
struct PointGrid {
    struct Entry {
        Vec3f position, normal;
    };
    std::vector<std::uint32_t> begin;  // by block, into entries
    std::vector<Entry> entries;

    static std::size_t block(float x) {
        return static_cast<std::size_t>(std::clamp((x + 0.5f) / kRoughnessRadius, 0.0f, kSide - 1.0f));
    }
    static std::size_t index(std::size_t x, std::size_t y, std::size_t z) { return (z * kSide + y) * kSide + x; }

    PointGrid(const FaceGraph& faces, const std::vector<Point>& points)
        : begin(kSide * kSide * kSide + 1, 0), entries(points.size()) {
        const auto block_of = [](const Vec3f& p) { return index(block(p.x()), block(p.y()), block(p.z())); };
        for (const Point& p : points)
            ++begin[block_of(p.position) + 1];
        for (std::size_t b = 1; b < begin.size(); ++b)
            begin[b] += begin[b - 1];
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for (const Point& p : points)
            entries[next[block_of(p.position)]++] = {p.position, faces.normal[p.slot]};
    }

    /// The normals of the points within the radius, in `buffer`.
    std::span<const Vec3f> normals_around(const Vec3f& p, std::vector<Vec3f>& buffer) const {
        const auto low = [](std::size_t i) { return i == 0 ? i : i - 1; };
        const auto high = [](std::size_t i) { return std::min(i + 1, kSide - 1); };
        const std::size_t x = block(p.x()), y = block(p.y()), z = block(p.z());
        std::size_t count = 0;
        for (std::size_t bz = low(z); bz <= high(z); ++bz) {
            for (std::size_t by = low(y); by <= high(y); ++by) {
                const std::uint32_t first = begin[index(low(x), by, bz)], last = begin[index(high(x), by, bz) + 1];
                if (buffer.size() < count + (last - first)) buffer.resize(count + (last - first));
                // Whether a point is near cannot be foretold: written in any case, a far one is overwritten.
                for (std::uint32_t i = first; i < last; ++i) {
                    buffer[count] = entries[i].normal;
                    count += (entries[i].position - p).squaredNorm() <= kRoughnessRadius * kRoughnessRadius;
                }
            }
        }
        return {buffer.data(), count};
    }
};

float roughness_at(const Vec3f& centre, const PointGrid& grid, std::vector<Vec3f>& buffer) {
    const std::span<const Vec3f> normals = grid.normals_around(centre, buffer);
    Vec3f mean = Vec3f::Zero();
    for (const Vec3f& n : normals)
        mean += n;
    mean.normalize();
    float sum = 0;
    for (const Vec3f& n : normals) {
        const float angle = angle_between(n, mean);
        sum += angle * angle;
    }
    return std::sqrt(sum / static_cast<float>(normals.size()));
}

}  // namespace

std::vector<JudgedPlace> judge_places(const IndexedMesh& mesh, const FaceGraph& faces) {
    const std::vector<Point> points = spread_points(mesh, faces);
    const PointGrid grid(faces, points);
    std::vector<JudgedPlace> places((points.size() + kEvery - 1) / kEvery);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size()), [&](const auto& range) {
        std::vector<Vec3f> buffer;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const Point& p = points[i * kEvery];
            places[i] = {roughness_at(p.position, grid, buffer), faces.face_of_slot[p.slot]};
        }
    });
    std::sort(places.begin(), places.end(), [](const JudgedPlace& a, const JudgedPlace& b) {
        return std::tuple(a.roughness, a.face) < std::tuple(b.roughness, b.face);
    });
    return places;
}

std::optional<double> selection_auc(const std::vector<JudgedPlace>& places, const PatchSet& patches) {
    // The area under the receiver operating characteristic, by the rank sum.
    const auto is_surfel = [&](const JudgedPlace& place) {
        const ClusterPatch& patch = patches.patches[patches.triangle_patch[place.face]];
        return patch.representation == format::Representation::kSurfels;
    };
    double triangles_below = 0, surfels = 0, won = 0;
    for (auto first = places.begin(); first != places.end();) {
        const auto last =
            std::find_if(first, places.end(), [&](const JudgedPlace& p) { return p.roughness != first->roughness; });
        const auto tied_surfels = static_cast<double>(std::count_if(first, last, is_surfel));
        const auto tied_triangles = static_cast<double>(last - first) - tied_surfels;
        won += tied_surfels * (triangles_below + tied_triangles / 2);
        triangles_below += tied_triangles;
        surfels += tied_surfels;
        first = last;
    }
    const double pairs = triangles_below * surfels;
    return pairs > 0 ? std::optional(won / pairs) : std::nullopt;
}

}  // namespace splice
