// The surfaces that RegionSimplifier leaves, by their positions: handles, fins, open borders.
#include "tests/simplify/open_edges.h"
#include "tests/simplify/patch_meshes.h"
#include "tests/simplify/simplified.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

using namespace splice;
using test::directed_edges;
using test::Edge;
using test::open_edges;
using test::Simplified;

namespace {

// A thin ring: the sides of its tube are nearer to each other than its edges along it are long, soon.
IndexedMesh torus(unsigned around, unsigned across) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    for (unsigned i = 0; i < around; ++i)
        for (unsigned k = 0; k < across; ++k) {
            const double turn = 2 * std::numbers::pi * i / around, tube = 2 * std::numbers::pi * k / across;
            const double r = 0.4 + 0.05 * std::cos(tube);
            positions.emplace_back(static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
                                   static_cast<float>(0.05 * std::sin(tube)));
            const auto at = [&](unsigned a, unsigned b) { return a % around * across + b % across; };
            triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return test::mesh_of(std::move(positions), std::move(triangles));
}

int euler_characteristic(std::span<const std::uint32_t> corners) {
    const std::set<std::uint32_t> vertices(corners.begin(), corners.end());
    std::set<Edge> edges;
    for (const auto& [edge, count] : directed_edges(corners))
        edges.insert(std::minmax(edge.first, edge.second));
    return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + static_cast<int>(corners.size() / 3);
}

bool is_manifold(std::span<const std::uint32_t> corners) {
    const auto edges = directed_edges(corners);
    return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 1; });
}

// As many triangles on either side of every edge.
bool is_closed(std::span<const std::uint32_t> corners) {
    const auto edges = directed_edges(corners);
    return std::ranges::all_of(edges, [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return back != edges.end() && back->second == edge.second;
    });
}

double area(const Simplified& simplified, std::span<const std::uint32_t> corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const auto at = [&](std::size_t k) { return simplified.mesh.positions[corners[i + k]].cast<double>().eval(); };
        sum += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
    }
    return sum;
}

std::size_t triangles_of(const RegionLevel& level) {
    return level.triangles.corners.size() / 3;
}

constexpr std::array kShares{0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.004, 0.001};

}  // namespace

TEST_CASE("a handle stays a handle where the topology is kept, and may be pinched where not, but never opens") {
    Simplified simplified{torus(120, 16)};
    const auto kept = simplified.levels(kShares), pinched = simplified.levels(kShares, false);
    REQUIRE(kept.size() >= 4);
    for (const RegionLevel& level : kept) {
        const std::vector<std::uint32_t> corners = simplified.positions(level);
        CAPTURE(corners.size() / 3);
        CHECK(is_manifold(corners));
        CHECK(is_closed(corners));
        CHECK(euler_characteristic(corners) == 0);
    }
    // Seven vertices are the least of a torus.
    CHECK(triangles_of(kept.back()) >= 14);
    REQUIRE(pinched.size() >= 4);
    for (const RegionLevel& level : pinched) {
        CAPTURE(triangles_of(level));
        CHECK(is_closed(simplified.positions(level)));
    }
    CHECK(std::ranges::any_of(pinched, [&](const RegionLevel& level) {
        const std::vector<std::uint32_t> corners = simplified.positions(level);
        return !is_manifold(corners) && euler_characteristic(corners) != 0;
    }));
    CHECK(triangles_of(pinched.back()) < triangles_of(kept.back()));
}

TEST_CASE("a triangle and its reverse are a fin, and go, and one that is left over stays") {
    // On flat ground a fin upright on an edge, and elsewhere a triangle twice and its reverse once, which leave one.
    IndexedMesh ground = test::height_field(9, [](float, float) { return 0.0f; });
    const std::vector<Triangle> flat = ground.triangles;
    std::vector<Vec3f> positions = ground.positions;
    const auto tip = static_cast<std::uint32_t>(positions.size());
    positions.emplace_back(0.0f, 0.0f, 0.3f);
    positions.emplace_back(0.3f, 0.3f, 0.3f);
    const std::uint32_t a = 44, b = 45, c = 66, d = 67;
    std::vector<Triangle> all = flat;
    all.insert(all.end(), {{a, b, tip}, {b, a, tip}, {c, d, tip + 1}, {tip + 1, c, d}, {d, c, tip + 1}});
    Simplified simplified{test::mesh_of(std::move(positions), std::move(all))};
    const auto levels = simplified.levels(std::array{0.9, 0.08});
    REQUIRE(levels.size() == 2);
    CHECK(std::ranges::count(simplified.positions(levels.front()), tip + 1) == 1);
    for (const RegionLevel& level : levels)
        CHECK(std::ranges::count(simplified.positions(level), tip) == 0);
    // Where the fin stood, the ground is as simple as anywhere.
    CHECK(std::ranges::count(simplified.positions(levels.back()), a) +
              std::ranges::count(simplified.positions(levels.back()), b) ==
          0);
}

TEST_CASE("an open border that is nobody else's is simplified along itself and keeps its corners") {
    Simplified simplified{test::height_field(24, [](float, float) { return 0.0f; })};
    const auto levels = simplified.levels(kShares);
    REQUIRE(levels.size() >= 5);
    const std::array<std::uint32_t, 4> square{0, 24, 600, 624};
    std::size_t before = 4 * 24;
    for (const RegionLevel& level : levels) {
        const std::vector<std::uint32_t> corners = simplified.positions(level);
        const std::set<Edge> border = open_edges(corners);
        CAPTURE(triangles_of(level), border.size());
        CHECK(is_manifold(corners));
        CHECK(euler_characteristic(corners) == 1);
        CHECK(area(simplified, corners) == Approx(1).epsilon(1e-6));
        for (const std::uint32_t corner : square)
            CHECK(std::ranges::count(corners, corner) > 0);
        for (const auto& [from, to] : border)
            for (const std::uint32_t end : {from, to})
                CHECK(simplified.mesh.positions[end].cwiseAbs().maxCoeff() == 0.5f);
        CHECK(border.size() <= before);
        before = border.size();
        CHECK(level.shape_error < 1e-6);
    }
    CHECK(before == 4);
    CHECK(triangles_of(levels.back()) == 2);
}

TEST_CASE("of an open border, what others share stays edge by edge") {
    Simplified simplified{test::height_field(24, [](float, float y) { return 0.1f * y * y; })};
    std::set<Edge> shared_edges;
    for (std::uint32_t i = 0; i <= 24; ++i)
        simplified.shared[i] = 1;
    for (std::uint32_t i = 0; i < 24; ++i)
        shared_edges.insert({i, i + 1});
    const auto levels = simplified.levels(kShares);
    REQUIRE(levels.size() >= 2);
    for (const RegionLevel& level : levels) {
        const std::set<Edge> border = open_edges(simplified.positions(level));
        CHECK(std::ranges::includes(border, shared_edges));
    }
    // The other three sides have been simplified.
    CHECK(open_edges(simplified.positions(levels.back())).size() < 24 + 24);
}
