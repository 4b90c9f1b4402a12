// The choice of a level of detail, without a device.
#include "engine/scene/ellipse_record.h"
#include "engine/scene/lod_cut.h"
#include "engine/scene/splat_reach.h"
#include "preprocess/lod/point_octree.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace splice;

namespace {

struct Points {
    std::vector<format::Surfel> surfels;
    std::vector<format::PointNode> nodes;
    PointHierarchy hierarchy;
};

glm::dvec3 vector_of(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

glm::dvec3 normal_of(std::uint32_t bits) {
    const auto n = decode_octahedral(bits);
    return {n[0], n[1], n[2]};
}

// Disks over a sphere of radius 0.4 that bulges.
Points bulging_sphere(std::size_t count) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    Points points;
    float largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 n = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const glm::vec3 p = (0.4f + 0.03f * std::sin(9 * n.x)) * n;
        const float radius = 1.5f / std::sqrt(static_cast<float>(count)) * (1 + 0.3f * std::abs(n.y));
        format::Surfel surfel{};
        for (int k = 0; k < 3; ++k)
            surfel.position[k] = p[k];
        surfel.radius = half_at_least(radius);
        surfel.extent = encode_extent({radius / 9, radius / 9, radius}, float_from_half(surfel.radius));
        surfel.normal = encode_octahedral(n.x, n.y, n.z);
        largest = std::max(largest, float_from_half(surfel.radius));
        points.surfels.push_back(surfel);
    }
    points.nodes = build_point_octree(points.surfels);
    points.hierarchy = point_hierarchy(points.nodes, {}, largest);
    return points;
}

// From `distance` in front of the model, turned a little, the picture 400 pixels high; scaled so that lengths that
// forget the scale show.
CutView view_from(double distance, double tau, bool orthographic = false, double off_centre = 0) {
    CutView view;
    view.scale = 3;
    const double c = std::cos(0.4), s = std::sin(0.4);
    view.model_to_view = glm::dmat4(glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c) * view.scale);
    view.model_to_view[3] = glm::dvec4(off_centre * view.scale, 0, -distance * view.scale, 1);
    view.orthographic = orthographic;
    const double half = orthographic ? 0.5 * view.scale : 0.36;
    view.half_x = view.half_y = half;
    view.pixel_scale = 200 / half;
    view.near_plane = 0.01;
    view.two_sided = true;
    view.tau = tau;
    return view;
}

// How often each surfel is in the cut.
std::vector<int> times_in(const LodCut& cut, const Points& points) {
    std::vector<int> times(points.surfels.size(), 0);
    const auto add = [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i)
            ++times[i];
    };
    for (const CutRun& run : cut.runs) {
        if (!run.inner) add(run.first, run.count);
        for (std::uint32_t i = run.first; run.inner && i < run.first + run.count; ++i)
            add(points.nodes[i].first_surfel, points.nodes[i].surfel_count);
    }
    return times;
}

std::uint64_t elements(const LodCut& cut) {
    return cut.statistics.ellipses + cut.statistics.surfels;
}

glm::dvec3 in_view(const CutView& view, const glm::dvec3& p) {
    return glm::dvec3(view.model_to_view * glm::dvec4(p, 1));
}

}  // namespace

TEST_CASE("a cut holds every surfel once, in order, whatever tau") {
    const Points points = bulging_sphere(20000);
    for (const bool orthographic : {false, true})
        for (const double tau : {1e-6, 0.5, 2.0, 8.0, 60.0, 1e6}) {
            CAPTURE(orthographic, tau);
            const LodCut cut = cut_points(points.hierarchy, view_from(3, tau, orthographic));
            const std::vector<int> times = times_in(cut, points);
            CHECK(std::count(times.begin(), times.end(), 1) == 20000);
            CHECK(cut.statistics.merged_surfels + cut.statistics.surfels == 20000);
            std::uint64_t next = 0;
            for (const CutRun& run : cut.runs) {
                const std::uint32_t first = run.inner ? points.nodes[run.first].first_surfel : run.first;
                CHECK(first == next);
                const std::uint32_t last = run.first + run.count - 1;
                next = run.inner ? points.nodes[last].first_surfel + points.nodes[last].surfel_count : last + 1;
            }
        }
    CHECK(elements(cut_points(points.hierarchy, view_from(3, 1e6))) == 1);
    CHECK(elements(cut_points(points.hierarchy, view_from(3, 1e-6))) == 20000);
}

TEST_CASE("what the picture shows is in the cut once, what it does not at most once") {
    const Points points = bulging_sphere(20000);
    // Beside the middle; and with the eye inside the model.
    for (const auto& [distance, off] : {std::pair{1.2, 0.35}, {0.3, 0.0}, {0.0, 0.1}}) {
        const CutView view = view_from(distance, 3, false, off);
        const LodCut cut = cut_points(points.hierarchy, view);
        const std::vector<int> times = times_in(cut, points);
        std::size_t shown = 0, missing = 0;
        for (std::size_t i = 0; i < times.size(); ++i) {
            const glm::dvec3 p = in_view(view, vector_of(points.surfels[i].position));
            const bool inside =
                -p.z > view.near_plane && std::abs(p.x) < -p.z * view.half_x && std::abs(p.y) < -p.z * view.half_y;
            shown += inside;
            missing += inside && times[i] != 1;
        }
        CAPTURE(distance, off);
        CHECK(shown > 500);
        CHECK(missing == 0);
        CHECK(*std::max_element(times.begin(), times.end()) == 1);
        CHECK(cut.statistics.outside_frustum > 0);
    }
}

TEST_CASE("nothing that faces the eye is left out of a one-sided model") {
    const Points points = bulging_sphere(20000);
    for (const double distance : {0.6, 3.0}) {
        CutView view = view_from(distance, 4);
        view.two_sided = false;
        const LodCut cut = cut_points(points.hierarchy, view);
        const std::vector<int> times = times_in(cut, points);
        std::size_t missing = 0;
        for (std::size_t i = 0; i < times.size(); ++i) {
            const glm::dvec3 p = in_view(view, vector_of(points.surfels[i].position));
            const glm::dvec3 n = glm::dmat3(view.model_to_view) * normal_of(points.surfels[i].normal) / view.scale;
            const bool inside =
                -p.z > view.near_plane && std::abs(p.x) < -p.z * view.half_x && std::abs(p.y) < -p.z * view.half_y;
            missing += inside && glm::dot(n, glm::normalize(-p)) >= kHorizon && times[i] != 1;
        }
        CAPTURE(distance);
        CHECK(missing == 0);
        CHECK(cut.statistics.facing_away > 10);
    }
}

TEST_CASE("no ellipse that is chosen is longer on the screen than tau, and none above it would do") {
    const Points points = bulging_sphere(20000);
    for (const bool orthographic : {false, true}) {
        const CutView view = view_from(1.5, 20, orthographic);
        const LodCut cut = cut_points(points.hierarchy, view);
        double longest = 0, shortest_parent = 1e9;
        const auto length = [&](const format::PointNode& node) {
            const glm::dvec3 centre = in_view(view, vector_of(node.position));
            const double reach = static_cast<double>(extent_of(node)) * view.scale;
            double result = 0;
            for (int i = 0; i < 64; ++i) {
                const double turn = i * std::numbers::pi / 64;
                const auto project = [&](double side) {
                    const glm::dvec3 p = centre + side * reach * glm::dvec3(std::cos(turn), std::sin(turn), 0);
                    return glm::dvec2(p) * view.pixel_scale / (orthographic ? 1.0 : -p.z);
                };
                result = std::max(result, glm::length(project(1) - project(-1)));
            }
            return result;
        };
        std::vector<std::uint32_t> parent(points.nodes.size(), 0);
        for (std::uint32_t i = 0; i < parent.size(); ++i)
            for (std::uint32_t k = 0; k < points.nodes[i].child_count; ++k)
                parent[points.nodes[i].first_child + k] = i;
        REQUIRE(cut.statistics.ellipses > 100);
        for (const CutRun& run : cut.runs)
            for (std::uint32_t i = run.first; run.inner && i < run.first + run.count; ++i) {
                longest = std::max(longest, length(points.nodes[i]));
                shortest_parent = std::min(shortest_parent, length(points.nodes[parent[i]]));
            }
        CAPTURE(orthographic);
        CHECK(longest <= view.tau * (1 + 1e-5));  // single precision
        CHECK(longest > 0.8 * view.tau);
        CHECK(shortest_parent > 0.75 * view.tau);
    }
}

TEST_CASE(
    "through a telescope nothing that the picture shows is left out, although choices are made in single precision") {
    const Points points = bulging_sphere(20000);
    for (const double distance : {30.0, 1e4, 1e7})
        for (const bool orthographic : {false, true}) {
            // A quarter of the model's width, beside the middle.
            CutView view = view_from(distance, 1, orthographic, 0.2);
            view.two_sided = false;
            view.half_x = view.half_y = orthographic ? 0.15 * view.scale : 0.15 / distance;
            view.pixel_scale = 200 / view.half_x;
            const std::vector<int> times = times_in(cut_points(points.hierarchy, view), points);
            std::size_t shown = 0, missing = 0;
            for (std::size_t i = 0; i < times.size(); ++i) {
                const glm::dvec3 p = in_view(view, vector_of(points.surfels[i].position));
                const glm::dvec3 n = glm::dmat3(view.model_to_view) * normal_of(points.surfels[i].normal) / view.scale;
                const double reach = orthographic ? 1 : -p.z;
                const bool inside = std::abs(p.x) < reach * view.half_x && std::abs(p.y) < reach * view.half_y;
                const glm::dvec3 to_eye = orthographic ? glm::dvec3(0, 0, 1) : glm::normalize(-p);
                shown += inside;
                missing += inside && glm::dot(n, to_eye) >= kHorizon && times[i] != 1;
            }
            CAPTURE(distance, orthographic);
            CHECK(shown > 500);
            CHECK(missing == 0);
        }
}

TEST_CASE("a larger tau never needs more") {
    const Points points = bulging_sphere(20000);
    std::uint64_t before = 20001;
    for (const double tau : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
        const std::uint64_t now = elements(cut_points(points.hierarchy, view_from(2, tau)));
        CHECK(now <= before);
        before = now;
    }
    CHECK(before < 500);
}

TEST_CASE("a cut does not depend on the threads") {
    const Points points = bulging_sphere(30000);
    const CutView view = view_from(1, 2, false, 0.2);
    const LodCut cut = cut_points(points.hierarchy, view);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const LodCut again = cut_points(points.hierarchy, view);
    CHECK(again.runs == cut.runs);
    CHECK(again.statistics == cut.statistics);
}

TEST_CASE("a tree that is one long branch is walked to its end") {
    std::vector<format::PointNode> nodes(200'000);
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        nodes[i].sphere_radius = nodes[i].major = 0.5f;
        nodes[i].surfel_count = 7;
        nodes[i].child_count = i + 1 < nodes.size() ? 1 : 0;
        nodes[i].first_child = i + 1 < nodes.size() ? i + 1 : 0;
    }
    // So small that what is above it does not end the walk.
    nodes.back().sphere_radius = nodes.back().major = 1e-9f;
    const CutView view = view_from(3, 1e-3);
    const LodCut cut = cut_points(point_hierarchy(nodes, {}, 0.1f), view);
    CHECK(cut.statistics.visited == nodes.size());
    REQUIRE(cut.runs.size() == 1);
    CHECK(cut.runs[0].inner);
    CHECK(cut.runs[0].first == nodes.size() - 1);
}

TEST_CASE("a node's record holds its ellipse, and hardly more") {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int round = 0; round < 500; ++round) {
        format::PointNode node{};
        node.normal = encode_octahedral(uniform(random), uniform(random), uniform(random));
        const glm::dvec3 n = normal_of(node.normal);
        const glm::dvec3 across =
            glm::normalize(glm::cross(n, glm::dvec3(uniform(random), uniform(random), uniform(random))));
        node.major_axis =
            encode_octahedral(static_cast<float>(across.x), static_cast<float>(across.y), static_cast<float>(across.z));
        node.major = 0.01f + 0.1f * std::abs(uniform(random));
        node.minor = node.major * (0.1f + 0.9f * std::abs(uniform(random)));
        const format::Surfel record = ellipse_record(node, 9);
        REQUIRE(is_ellipse_record(record));
        CHECK(record.patch == 9);
        const EllipseAxes axes = ellipse_axes(record);
        const TangentFrame frame = tangents_of(decode_octahedral(record.normal));
        const glm::dvec3 s(frame.s[0], frame.s[1], frame.s[2]), t(frame.t[0], frame.t[1], frame.t[2]);
        const glm::dvec3 major = std::cos(axes.turn) * s + std::sin(axes.turn) * t, minor = glm::cross(n, major);
        const glm::dvec3 own_major = normal_of(node.major_axis), own_minor = glm::cross(n, own_major);
        double farthest = 0;
        for (int i = 0; i < 128; ++i) {
            const double turn = i * std::numbers::pi / 64;
            const glm::dvec3 p = static_cast<double>(node.major) * std::cos(turn) * own_major +
                                 static_cast<double>(node.minor) * std::sin(turn) * own_minor;
            farthest = std::max(farthest, std::hypot(glm::dot(p, major) / axes.major, glm::dot(p, minor) / axes.minor));
        }
        CHECK(farthest <= 1 + 1e-4);
        CHECK(axes.major <= 1.1 * static_cast<double>(node.major));
        CHECK(axes.minor <= 1.15 * static_cast<double>(node.minor));
    }
}

TEST_CASE("a patch is in the cut by its triangles or by its surfels, whichever cost less") {
    // Of the nodes of one level, each stands for a patch.
    Points points = bulging_sphere(20000);
    std::vector<format::Patch> patches;
    const format::PointNode& root = points.nodes.front();
    for (std::uint32_t child = 0; child < root.child_count; ++child) {
        const format::PointNode& node = points.nodes[root.first_child + child];
        format::Patch patch{};
        patch.first_surfel = node.first_surfel;
        patch.surfel_count = node.surfel_count;
        patches.push_back(patch);
    }
    REQUIRE(patches.size() > 2);
    points.hierarchy = point_hierarchy(points.nodes, patches, points.hierarchy.largest_radius);
    CutView view = view_from(2, 4);
    const LodCut surfels = cut_points(points.hierarchy, view);
    const auto cut_with = [&](const std::vector<double>& costs) {
        view.triangle_costs = costs;
        return cut_points(points.hierarchy, view);
    };
    std::vector<double> costs(patches.size(), 1e9);
    CHECK(times_in(cut_with(costs), points) == times_in(surfels, points));
    CHECK(elements(cut_with(costs)) == elements(surfels));
    CHECK(cut_with(costs).triangle_patches.empty());
    costs.assign(patches.size(), 0);
    CHECK(cut_with(costs).runs.empty());
    CHECK(cut_with(costs).triangle_patches.size() == patches.size());
    // One patch at exactly what its surfels cost, and at less: only that patch changes.
    costs.assign(patches.size(), 1e9);
    costs[1] = 0;
    const std::uint64_t own = elements(surfels) - elements(cut_with(costs));
    REQUIRE(own > 10);
    costs[1] = static_cast<double>(own);
    CHECK(elements(cut_with(costs)) == elements(surfels));
    CHECK(cut_with(costs).triangle_patches.empty());
    costs[1] = static_cast<double>(own) - 1;
    const LodCut mixed = cut_with(costs);
    CHECK(mixed.triangle_patches == std::vector<std::uint32_t>{1});
    const std::vector<int> times = times_in(mixed, points);
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool inside = i >= patches[1].first_surfel && i < patches[1].first_surfel + patches[1].surfel_count;
        if (times[i] != (inside ? 0 : 1)) {
            CAPTURE(i, inside, times[i]);
            FAIL("a surfel is not in the cut as often as it should be");
        }
    }
}

TEST_CASE("surfels that triangles of several patches are drawn for are not in the cut, all others once") {
    // Nodes of two levels of the tree stand for patches and for nodes of the octree.
    Points points = bulging_sphere(20000);
    std::vector<format::Patch> patches;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> groups;  // of patches: first, end
    const format::PointNode& root = points.nodes.front();
    for (std::uint32_t child = 0; child < root.child_count; ++child) {
        const format::PointNode& node = points.nodes[root.first_child + child];
        const auto first = static_cast<std::uint32_t>(patches.size());
        groups.emplace_back(first, first + node.child_count);
        for (std::uint32_t k = 0; k < node.child_count; ++k) {
            format::Patch patch{};
            patch.first_surfel = points.nodes[node.first_child + k].first_surfel;
            patch.surfel_count = points.nodes[node.first_child + k].surfel_count;
            patches.push_back(patch);
        }
    }
    points.hierarchy = point_hierarchy(points.nodes, patches, points.hierarchy.largest_radius);
    const auto surfels_of = [&](std::uint32_t first, std::uint32_t end) {
        const format::Patch& last = patches[end - 1];
        return std::pair{static_cast<std::uint32_t>(patches[first].first_surfel),
                         static_cast<std::uint32_t>(last.first_surfel + last.surfel_count)};
    };
    CutView view = view_from(2, 4);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> left_out{surfels_of(groups[0].first, groups[0].second),
                                                                        surfels_of(groups[3].first, groups[3].second)};
    view.left_out = left_out;
    const std::vector<int> times = times_in(cut_points(points.hierarchy, view), points);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < times.size(); ++i) {
        const bool out =
            (i >= left_out[0].first && i < left_out[0].second) || (i >= left_out[1].first && i < left_out[1].second);
        wrong += times[i] != (out ? 0 : 1);
    }
    CHECK(wrong == 0);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> all{surfels_of(0, groups.back().second)};
    view.left_out = all;
    CHECK(cut_points(points.hierarchy, view).runs.empty());
}
