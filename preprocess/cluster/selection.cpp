#include "preprocess/cluster/selection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace splice {

std::vector<float> score_faces(const FaceGraph& faces, const FaceRoughness& roughness) {
    constexpr float kDiskArea = std::numbers::pi_v<float> * kRoughnessRadius * kRoughnessRadius;
    std::vector<float> scores(faces.size());
    for (std::size_t s = 0; s < faces.size(); ++s) {
        const float triangles_in_ball = kDiskArea / faces.area[s];
        scores[s] = std::min(roughness.ball[s] * std::min(1.0f, triangles_in_ball / kFewTriangles),
                             kSheetFactor * roughness.sheet[s]);
    }
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
