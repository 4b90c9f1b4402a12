#include "preprocess/cloud/vicinity.h"
#include "preprocess/cloud/voronoi_cell.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

using namespace splice;

namespace {

// `count` neighbours about a rough plane, the nearest first; on a lattice, where corners coincide, for `lattice`.
Vicinity random_vicinity(std::mt19937& random, std::size_t count, bool lattice = false) {
    std::uniform_real_distribution<float> share(-1, 1);
    std::vector<Vec3f> offsets;
    while (offsets.size() < count) {
        Vec3f offset(share(random), share(random), 0.3f * share(random));
        if (lattice) offset = Vec3f(std::round(2 * offset.x()), std::round(2 * offset.y()), 0);
        if (offset != Vec3f::Zero()) offsets.push_back(offset);
    }
    std::ranges::sort(offsets, {}, [](const Vec3f& v) { return v.squaredNorm(); });
    Vicinity vicinity;
    vicinity.count = count;
    vicinity.x.fill(0);
    vicinity.y.fill(0);
    vicinity.z.fill(0);
    for (std::size_t i = 0; i < count; ++i) {
        vicinity.x[i] = offsets[i].x();
        vicinity.y[i] = offsets[i].y();
        vicinity.z[i] = offsets[i].z();
    }
    return vicinity;
}

CellPlane random_plane(std::mt19937& random) {
    std::normal_distribution<float> normal(0, 0.2f);
    const Vec3f n = Vec3f(normal(random), normal(random), 1).normalized();
    return {n, tangents_of({n.x(), n.y(), n.z()}), 0.5f};
}

// By cutting a polygon.
SmallCell cut_cell(const Vicinity& vicinity, const CellPlane& plane, float limit) {
    VoronoiCell cell(limit);
    const auto& [s, t] = plane.frame;
    for (std::uint32_t i = 0; i < vicinity.count; ++i) {
        const Vec3f v = vicinity.offset(i);
        const Eigen::Vector2f site(v.dot(Vec3f(s[0], s[1], s[2])), v.dot(Vec3f(t[0], t[1], t[2])));
        if (site.norm() > plane.least_cosine * v.norm()) cell.cut(site, i);
    }
    SmallCell result;
    result.is_bounded = cell.is_bounded() && cell.reach(false) < limit;
    result.reach = cell.reach(true);
    cell.neighbours([&](std::uint32_t i) {
        const float height = vicinity.offset(i).dot(plane.normal);
        result.above = std::max(result.above, height);
        result.below = std::max(result.below, -height);
    });
    return result;
}

}  // namespace

TEST_CASE("the cell among sixteen neighbours is that which a polygon is cut to") {
    std::mt19937 random(3);
    const VicinityFunctions functions = vicinity_functions();
    std::size_t bounded = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vicinity vicinity = random_vicinity(random, 1 + static_cast<std::size_t>(i) % 16);
        const CellPlane plane = random_plane(random);
        const float limit = vicinity.distance(vicinity.count - 1);
        const SmallCell expected = cut_cell(vicinity, plane, limit),
                        found = functions.small_cell(vicinity, plane, limit);
        // Within rounding of the limit either answer is right.
        if (std::abs(expected.reach - limit) < 1e-4f) continue;
        INFO("vicinity " << i);
        REQUIRE(found.is_bounded == expected.is_bounded);
        if (!found.is_bounded) continue;
        ++bounded;
        REQUIRE(found.reach == Approx(expected.reach).epsilon(1e-3));
        REQUIRE(found.above == Approx(expected.above).margin(1e-6));
        REQUIRE(found.below == Approx(expected.below).margin(1e-6));
    }
    CHECK(bounded > 2000);
}

TEST_CASE("the cell of a lattice point is its square, and of a line's point it is open") {
    const VicinityFunctions functions = vicinity_functions();
    const CellPlane plane{Vec3f::UnitZ(), tangents_of({0, 0, 1}), 0.5f};
    const auto cell_of = [&](const std::vector<std::array<float, 2>>& sites, float limit) {
        Vicinity vicinity;
        vicinity.count = sites.size();
        vicinity.x.fill(0);
        vicinity.y.fill(0);
        vicinity.z.fill(0);
        for (std::size_t i = 0; i < sites.size(); ++i) {
            vicinity.x[i] = sites[i][0];
            vicinity.y[i] = sites[i][1];
        }
        return functions.small_cell(vicinity, plane, limit);
    };
    std::vector<std::array<float, 2>> square{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const SmallCell lattice = cell_of(square, 2);
    CHECK(lattice.is_bounded);
    CHECK(lattice.reach == Approx(std::sqrt(0.5)));
    // Without the point on one side it goes on beyond the limit or to the corners of the next ones.
    square.erase(square.begin());
    CHECK(cell_of(square, 2).reach == Approx(1));
    const SmallCell line = cell_of({{1, 0}, {-1, 0}, {2, 0}, {-2, 0}}, 2);
    CHECK_FALSE(line.is_bounded);
    CHECK(line.reach == 0);
    CHECK_FALSE(cell_of({{1, 0}, {0, 1}, {0, -1}}, 2).is_bounded);
}

TEST_CASE("moments are sums over the neighbours asked for, and no others") {
    std::mt19937 random(4);
    const VicinityFunctions functions = vicinity_functions();
    for (const std::size_t count : {1u, 15u, 16u, 17u, 40u, 64u, 256u}) {
        const Vicinity vicinity = random_vicinity(random, count);
        for (const std::size_t asked : {std::size_t{1}, (count + 1) / 2, count}) {
            double x = 0, yz = 0, zz = 0;
            for (std::size_t i = 0; i < asked; ++i) {
                x += static_cast<double>(vicinity.x[i]);
                yz += static_cast<double>(vicinity.y[i]) * static_cast<double>(vicinity.z[i]);
                zz += static_cast<double>(vicinity.z[i]) * static_cast<double>(vicinity.z[i]);
            }
            const Moments moments = functions.moments(vicinity, asked);
            CHECK(moments.x == Approx(x).margin(1e-4));
            CHECK(moments.yz == Approx(yz).margin(1e-4));
            CHECK(moments.zz == Approx(zz).margin(1e-4));
        }
    }
}

TEST_CASE("the processor's vectors compute of a vicinity what plain code does, bit by bit") {
    std::mt19937 random(5);
    const VicinityFunctions wide = vicinity_functions(), plain = vicinity_functions(false);
    std::size_t different = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vicinity vicinity = random_vicinity(random, 1 + static_cast<std::size_t>(i) % 16, i % 3 == 0);
        const CellPlane plane = random_plane(random);
        const float limit = vicinity.distance(vicinity.count - 1);
        const SmallCell a = wide.small_cell(vicinity, plane, limit), b = plain.small_cell(vicinity, plane, limit);
        different += std::memcmp(&a.reach, &b.reach, sizeof(float)) != 0 || a.above != b.above || a.below != b.below ||
                     a.is_bounded != b.is_bounded;
        const Moments m = wide.moments(vicinity, vicinity.count), n = plain.moments(vicinity, vicinity.count);
        different += std::memcmp(&m, &n, sizeof m) != 0;
    }
    CHECK(different == 0);
}
