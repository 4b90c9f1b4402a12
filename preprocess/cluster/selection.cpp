#include "preprocess/cluster/selection.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace splice {

namespace {

constexpr float kFewTriangles = 9;  // on a disk of kRoughnessRadius
constexpr float kSheetFactor = 2;
constexpr float kContinues = 0.0175f;  // radians between neighbours, 1 degree
constexpr float kPlaneBend = 0.0044f;  // radians between neighbours, 0.25 degrees
constexpr double kPlaneSpread = kRoughScore / 2;
constexpr double kPlaneArea = 0.25 * std::numbers::pi * kRoughnessRadius * kRoughnessRadius;
constexpr std::uint32_t kPlaneFaces = 4;

float bend(const FaceGraph& faces, const FaceGraph::Link& link) {
    return (faces.normal[link.slot[0]] - faces.normal[link.slot[1]]).norm();
}

/// Slots with a neighbour that continues the face.
std::vector<std::uint8_t> find_continued(const FaceGraph& faces) {
    std::vector<std::uint8_t> continued(faces.size(), 0);
    for (const FaceGraph::Link& l : faces.links) {
        if (bend(faces, l) <= kContinues) continued[l.slot[0]] = continued[l.slot[1]] = 1;
    }
    return continued;
}

/// Slots that belong to a plane: components over edges that do not bend, if they stay flat as a whole.
std::vector<std::uint8_t> find_planes(const FaceGraph& faces) {
    std::vector<std::uint32_t> parent(faces.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t s) {
        while (parent[s] != s)
            s = parent[s] = parent[parent[s]];
        return s;
    };
    for (const FaceGraph::Link& l : faces.links) {
        if (bend(faces, l) > kPlaneBend) continue;
        const std::uint32_t a = root(l.slot[0]), b = root(l.slot[1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    struct Component {
        Vec3d normal_sum = Vec3d::Zero();
        double area = 0;
        std::uint32_t faces = 0;
    };
    std::vector<Component> components(faces.size());
    for (std::uint32_t s = 0; s < faces.size(); ++s) {
        Component& c = components[root(s)];
        c.normal_sum += static_cast<double>(faces.area[s]) * faces.normal[s].cast<double>();
        c.area += static_cast<double>(faces.area[s]);
        ++c.faces;
    }
    std::vector<std::uint8_t> plane(faces.size(), 0);
    for (std::uint32_t s = 0; s < faces.size(); ++s) {
        const Component& c = components[root(s)];
        const double variance = 2 * (1 - c.normal_sum.norm() / c.area);
        plane[s] = c.faces >= kPlaneFaces && c.area >= kPlaneArea && variance <= kPlaneSpread * kPlaneSpread;
    }
    return plane;
}

}  // namespace

std::vector<float> score_faces(const FaceGraph& faces, const FaceRoughness& roughness) {
    std::vector<std::uint8_t> continued, plane;
    tbb::parallel_invoke([&] { continued = find_continued(faces); }, [&] { plane = find_planes(faces); });
    std::vector<float> scores(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t s) {
        if (plane[s]) return;  // 0
        scores[s] = roughness.ball[s] * std::min(1.0f, roughness.triangles[s] / kFewTriangles);
        const float sheet = kSheetFactor * roughness.sheet[s];
        if (continued[s] && sheet <= kRoughScore) scores[s] = std::min(scores[s], sheet);
    });
    return scores;
}

float score_at_share(const std::vector<float>& scores, double share) {
    const auto count = static_cast<std::size_t>(std::llround(share * static_cast<double>(scores.size())));
    if (count == 0) return -1.0f;  // below every score
    std::vector<float> ranked = scores;
    const auto nth = ranked.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(ranked.begin(), nth, ranked.end());
    return *nth;
}

std::vector<std::uint32_t> choose_flattest(std::vector<ScoredPatch> patches, std::uint64_t target) {
    std::sort(patches.begin(), patches.end(), [](const ScoredPatch& a, const ScoredPatch& b) {
        return std::tuple(a.score, a.slot) < std::tuple(b.score, b.slot);
    });
    std::vector<std::uint32_t> chosen;
    std::uint64_t room = target;
    for (const ScoredPatch& patch : patches) {
        if (patch.faces > room) continue;
        chosen.push_back(patch.slot);
        room -= patch.faces;
    }
    return chosen;
}

}  // namespace splice
