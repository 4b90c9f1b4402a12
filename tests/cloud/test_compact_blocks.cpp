#include "preprocess/cloud/compact_blocks.h"
#include "tests/cloud/cloud_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::size_t kBlock = 16;

std::vector<PlacedPoint> placed(const std::vector<Vec3f>& positions) {
    std::vector<PlacedPoint> points;
    for (const Vec3f& p : positions)
        points.push_back({{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(points.size())});
    return points;
}

bool is_permutation_of(std::span<const PlacedPoint> points, const std::vector<Vec3f>& positions) {
    std::vector<char> seen(positions.size(), 0);
    for (const PlacedPoint& point : points) {
        const Vec3f& p = positions[point.index];
        if (seen[point.index]++ != 0 || point.position != std::array{p.x(), p.y(), p.z()}) return false;
    }
    return points.size() == positions.size();
}

// Mean over blocks of the sum of the sides of their boxes.
float mean_girth(std::span<const PlacedPoint> points) {
    float sum = 0, blocks = 0;
    for (std::size_t first = 0; first < points.size(); first += kBlock, ++blocks)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] = std::ranges::minmax(points.subspan(first, std::min(kBlock, points.size() - first)),
                                                         {}, [&](const PlacedPoint& p) { return p.position[axis]; });
            sum += high.position[axis] - low.position[axis];
        }
    return sum / blocks;
}

}  // namespace

TEST_CASE("blocks are compact, and all points are still there") {
    const std::vector<Vec3f> positions = sphere_points(4000, 1);
    std::vector<PlacedPoint> points = placed(positions);
    order_by_blocks(points, kBlock);
    CHECK(is_permutation_of(points, positions));
    // A share of this sphere of radius 0.5 is about 0.11 wide; of points in any order, the sides sum up to 3.
    CHECK(mean_girth(points) < 0.35f);
}

TEST_CASE("a grid's blocks are its squares") {
    std::vector<Vec3f> positions;
    for (int i = 0; i < 1024; ++i)
        positions.emplace_back(static_cast<float>(i * 7 % 32), static_cast<float>(i / 32), 0.0f);
    std::vector<PlacedPoint> points = placed(positions);
    order_by_blocks(points, kBlock);
    CHECK(is_permutation_of(points, positions));
    CHECK(mean_girth(points) == 6);
}

TEST_CASE("points on a line, all equal but one, or fewer than a block are ordered as well") {
    for (const std::size_t count : {1, 5, 16, 17, 33, 1000}) {
        std::vector<Vec3f> line, same(count, Vec3f(1, 2, 3));
        for (std::size_t i = 0; i < count; ++i)
            line.emplace_back(0.0f, static_cast<float>((i * 389) % count), 0.0f);
        same[count / 2] = Vec3f(0, 2, 3);
        for (const std::vector<Vec3f>& positions : {line, same}) {
            std::vector<PlacedPoint> points = placed(positions);
            order_by_blocks(points, kBlock);
            CHECK(is_permutation_of(points, positions));
        }
        std::vector<PlacedPoint> points = placed(line);
        order_by_blocks(points, kBlock);
        CHECK(mean_girth(points) <= 15);
    }
}
