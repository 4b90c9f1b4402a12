#include "preprocess/cloud/neighbour_search.h"
#include "preprocess/cloud/unit_cloud.h"
#include "tests/cloud/cloud_shapes.h"

#include <catch2/catch.hpp>
#include <nanoflann.hpp>

using namespace splice;
using namespace splice::test;

namespace {

struct Points {
    const std::vector<Vec3f>& points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t point, std::size_t axis) const {
        return points[point][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t>;

// The same distances as a kd-tree's, each index once and never the point itself.
void check_against_kd_tree(const std::vector<Vec3f>& points, unsigned k) {
    const Points adaptor{points};
    const KdTree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(12));
    const NeighbourSearch search(points);
    NeighbourSearch::Lists lists;
    std::vector<std::uint32_t> indices(k + 1);
    std::vector<float> distances(k + 1);
    std::size_t wrong = 0;
    for (std::size_t point = 0; point < points.size(); ++point) {
        if (point % NeighbourSearch::kBlock == 0) search.find(point / NeighbourSearch::kBlock, k, lists);
        const auto found = lists.of(point % NeighbourSearch::kBlock);
        const std::size_t expected = tree.knnSearch(points[point].data(), k + 1, indices.data(), distances.data()) - 1;
        std::vector<std::uint32_t> own;
        for (std::size_t i = 0; i < k; ++i) {
            if (i >= expected) {
                wrong += found[i] != kNoNeighbour;
                continue;
            }
            // The kd-tree finds the point itself first.
            wrong += std::abs(squared_distance_of(found[i]) - distances[i + 1]) > 1e-6f * distances[i + 1];
            wrong += index_of(found[i]) == point;
            wrong += i > 0 && !(found[i - 1] < found[i]);
            own.push_back(index_of(found[i]));
        }
        std::sort(own.begin(), own.end());
        wrong += std::adjacent_find(own.begin(), own.end()) != own.end();
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("neighbours are those that a kd-tree finds") {
    check_against_kd_tree(unit_cloud(sphere_points(20000, 1)).positions, 16);
    check_against_kd_tree(unit_cloud(sphere_points(3000, 2)).positions, 1);
    check_against_kd_tree(unit_cloud(sphere_points(3000, 2)).positions, 40);
    // In any order, and of any number up to a block's.
    check_against_kd_tree(sphere_points(2000, 3), 8);
    for (std::size_t points = 1; points <= 35; ++points)
        check_against_kd_tree(unit_cloud(sphere_points(points, 4)).positions, 16);
}

TEST_CASE("neighbours on a lattice, where most distances are equal, come by their index") {
    std::vector<Vec3f> lattice;
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 10; ++x)
                lattice.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    const NeighbourSearch search(lattice);
    NeighbourSearch::Lists lists;
    search.find(0, 3, lists);
    std::vector<std::uint32_t> found;
    for (const Neighbour neighbour : lists.of(5))  // point (5, 0, 0)
        found.push_back(index_of(neighbour));
    CHECK(found == std::vector<std::uint32_t>{4, 6, 15});
}

TEST_CASE("only the points that are asked for are searched") {
    const std::vector<Vec3f> points = unit_cloud(sphere_points(500, 5)).positions;
    const NeighbourSearch search(points);
    NeighbourSearch::Lists all, one;
    search.find(3, 16, all);
    search.find(3, 16, one, 1u << 7);
    CHECK(std::equal(all.of(7).begin(), all.of(7).end(), one.of(7).begin()));
    CHECK(one.of(6).front() == kNoNeighbour);
}

TEST_CASE("a bound from the block before loses no neighbours") {
    // From the dense patch to the sparse one; the search of the first block of the second is bounded by the first's.
    std::vector<Vec3f> points = sphere_points(64, 7);
    for (Vec3f& point : points)
        point *= 1e-3f;
    for (const Vec3f& point : sphere_points(64, 8))
        points.emplace_back(point + Vec3f(3, 0, 0));
    check_against_kd_tree(points, 16);
    // So near to each other that squared distances are 0.
    for (Vec3f& point : points)
        point *= 1e-24f;
    const NeighbourSearch search(points);
    NeighbourSearch::Lists lists;
    for (std::size_t block = 0; block < search.blocks(); ++block)
        search.find(block, 16, lists);
    CHECK(lists.of(15).back() != kNoNeighbour);
}

TEST_CASE("the processor's vectors find what plain code finds, bit by bit") {
    const std::vector<Vec3f> points = unit_cloud(sphere_points(kBlockPoints * 40, 5)).positions;
    std::vector<PointBlock> blocks(points.size() / kBlockPoints);
    std::vector<Box3> boxes(blocks.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        PointBlock& block = blocks[i / kBlockPoints];
        Box3& box = boxes[i / kBlockPoints];
        const std::size_t place = i % kBlockPoints;
        block.x[place] = points[i].x();
        block.y[place] = points[i].y();
        block.z[place] = points[i].z();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float value = points[i][static_cast<Eigen::Index>(axis)];
            box.low[axis] = place == 0 ? value : std::min(box.low[axis], value);
            box.high[axis] = place == 0 ? value : std::max(box.high[axis], value);
        }
    }
    const NearFunctions plain = near_functions(false), wide = near_functions();
    for (const unsigned k : {3u, 8u, 16u, 17u, 64u}) {
        const std::size_t stride = (k + kListStep - 1) / kListStep * kListStep;
        const auto search = [&](const NearFunctions& functions) {
            struct alignas(64) Line {
                std::array<Neighbour, kListStep> entries;
            };
            std::vector<Line> storage(kBlockPoints * stride / kListStep);
            for (Line& line : storage)
                line.entries.fill(kNoNeighbour);
            NearLists lists;
            lists.k = k;
            lists.stride = stride;
            lists.first = storage.front().entries.data();
            lists.reach.fill(1e28f);
            lists.reach[3] = -1;  // not asked for
            for (std::size_t b = 0; b < blocks.size(); ++b)
                functions.add(blocks[7], blocks[b], boxes[b], static_cast<std::uint32_t>(b * kBlockPoints), b == 7,
                              lists);
            std::vector<Neighbour> found;
            for (std::size_t q = 0; q < kBlockPoints; ++q) {
                functions.settle(lists, q);
                found.insert(found.end(), lists.first + q * stride, lists.first + q * stride + k);
            }
            return found;
        };
        const auto expected = search(plain);
        CHECK(search(wide) == expected);
        CHECK(expected[3 * k] == kNoNeighbour);
        CHECK(expected[4 * k] != kNoNeighbour);
    }
    BoxGroup group;
    for (std::size_t i = 0; i < kGroupBoxes; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            group.low[axis][i] = boxes[i].low[axis];
            group.high[axis][i] = boxes[i].high[axis];
        }
    for (const float farthest : {0.0f, 0.001f, 0.01f, 0.1f, 10.0f})
        CHECK(wide.near_boxes(group, boxes[9], farthest) == plain.near_boxes(group, boxes[9], farthest));
    CHECK(plain.near_boxes(group, boxes[2], 0) != 0);
    CHECK(plain.near_boxes(group, boxes[2], 0) != 0xff);
    CHECK(plain.near_boxes(group, boxes[9], 10) == 0xff);
}
