#include "preprocess/build_model/patch_octree.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>
#include <random>

using namespace splice;

namespace {

Box box_at(const Vec3f& centre, float half) {
    Box box;
    box.add(Vec3f(centre - Vec3f::Constant(half)));
    box.add(Vec3f(centre + Vec3f::Constant(half)));
    return box;
}

// Every patch is in exactly one leaf, every node bounds its patches, children divide their parent in order.
void check_octree(const std::vector<Box>& bounds) {
    const PatchOctree octree = build_patch_octree(bounds);
    std::vector<std::uint32_t> sorted = octree.order;
    std::ranges::sort(sorted);
    std::vector<std::uint32_t> all(bounds.size());
    std::iota(all.begin(), all.end(), 0u);
    CHECK(sorted == all);

    REQUIRE(!octree.nodes.empty());
    CHECK(octree.nodes[0].patch_count == bounds.size());
    std::uint32_t next_child = 1, leaf_patches = 0;
    for (const format::OctreeNode& node : octree.nodes) {
        for (std::uint32_t i = 0; i < node.patch_count; ++i) {
            const Box& box = bounds[octree.order[node.first_patch + i]];
            for (int axis = 0; axis < 3; ++axis) {
                CHECK(node.bounds_min[axis] <= box.min[axis]);
                CHECK(node.bounds_max[axis] >= box.max[axis]);
            }
        }
        if (node.child_count == 0) {
            CHECK(node.patch_count <= kMaxLeafPatches);
            leaf_patches += node.patch_count;
            continue;
        }
        CHECK(node.child_count >= 2);
        CHECK(node.child_count <= 8);
        CHECK(node.first_child == next_child);
        next_child += node.child_count;
        std::uint32_t patch = node.first_patch;
        for (std::uint32_t i = 0; i < node.child_count; ++i) {
            CHECK(octree.nodes[node.first_child + i].first_patch == patch);
            patch += octree.nodes[node.first_child + i].patch_count;
        }
        CHECK(patch == node.first_patch + node.patch_count);
    }
    CHECK(next_child == octree.nodes.size());
    CHECK(leaf_patches == bounds.size());
}

}  // namespace

TEST_CASE("a few patches make one leaf") {
    check_octree({box_at(Vec3f::Zero(), 1)});
    check_octree(std::vector<Box>(8, box_at(Vec3f::UnitX(), 0.1f)));
}

TEST_CASE("random patches make a well-formed octree") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-0.5f, 0.5f);
    for (const std::size_t count : {9u, 100u, 3000u}) {
        std::vector<Box> bounds;
        for (std::size_t i = 0; i < count; ++i)
            bounds.push_back(box_at({coordinate(random), coordinate(random), coordinate(random)}, 0.01f));
        check_octree(bounds);
    }
}

TEST_CASE("many patches in one place are divided all the same") {
    check_octree(std::vector<Box>(1000, box_at(Vec3f(0.1f, 0.2f, 0.3f), 0.05f)));
}

TEST_CASE("patches on a line make a well-formed octree") {
    std::vector<Box> bounds;
    for (int i = 0; i < 200; ++i)
        bounds.push_back(box_at({static_cast<float>(i) / 1000, 0, 0}, 0.001f));
    check_octree(bounds);
}

TEST_CASE("near patches are near in the order") {
    std::vector<Box> bounds;
    for (int i = 0; i < 64; ++i)
        bounds.push_back(box_at({static_cast<float>(i * 37 % 64), 0, 0}, 0.1f));
    const PatchOctree octree = build_patch_octree(bounds);
    for (std::size_t i = 1; i < octree.order.size(); ++i)
        CHECK(bounds[octree.order[i]].min.x() > bounds[octree.order[i - 1]].min.x());
}
