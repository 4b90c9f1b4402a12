#include "engine/scene/merged_surfels.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"

#include <glm/glm.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace splice {

namespace {

constexpr std::size_t kMost = 4;  // surfels that become one
constexpr float kReach = 0.8f;    // typical spacings from their mean
constexpr float kAgree = 0.9f;    // cosine between their normals and the mean
constexpr std::size_t kRounds = 6;
constexpr double kWorthwhile =
    0.6;  // share of what is finer that a level may have; so all have less than 1.5 times the surfels
constexpr float kLargestHalf = 65504;

glm::vec3 vector(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}
glm::vec3 position_of(const format::Surfel& surfel) {
    return {surfel.position[0], surfel.position[1], surfel.position[2]};
}
float radius_of(const format::Surfel& surfel) {
    return float_from_half(surfel.radius);
}

struct Frame {
    glm::vec3 s, t, n;
};

Frame frame_of(std::uint32_t normal) {
    const std::array<float, 3> n = decode_octahedral(normal);
    const TangentFrame tangents = tangents_of(n);
    return {vector(tangents.s), vector(tangents.t), vector(n)};
}

// How far the shading normal leans from the plane's along a tangent, and back.
float lean_of(std::int8_t bend, std::size_t axis) {
    return static_cast<float>(bend) / 127 * format::kLargestBend[axis];
}
std::int8_t bend_of(float lean, std::size_t axis) {
    return static_cast<std::int8_t>(std::lround(std::clamp(lean / format::kLargestBend[axis], -1.0f, 1.0f) * 127));
}

// How far consecutive surfels are apart: the median, over the surfels, of the distance to the nearest of the next few.
float spacing_of(std::span<const format::Surfel> surfels) {
    constexpr std::size_t kNext = 4;
    std::vector<float> distances;
    distances.reserve(surfels.size());
    for (std::size_t i = 0; i + 1 < surfels.size(); ++i) {
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t j = i + 1; j < std::min(i + 1 + kNext, surfels.size()); ++j)
            least = std::min(least, glm::distance(position_of(surfels[i]), position_of(surfels[j])));
        distances.push_back(least);
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    return *middle;
}

// Surfels that become one.
struct Cluster {
    std::span<const format::Surfel> surfels;
    glm::vec3 mean{0};
    float shift = 0;  // of the centres, at most
    float slant = 0;  // of a rim against the disk that holds it, at most; known once merged

    explicit Cluster(std::span<const format::Surfel> members) : surfels(members) {
        glm::vec3 sum(0);
        for (const format::Surfel& surfel : surfels)
            sum += position_of(surfel);
        mean = sum / static_cast<float>(surfels.size());
        for (const format::Surfel& surfel : surfels)
            shift = std::max(shift, glm::distance(mean, position_of(surfel)));
    }

    bool agrees() const {
        glm::vec3 sum(0);
        for (const format::Surfel& surfel : surfels)
            sum += vector(decode_octahedral(surfel.normal));
        const float length = glm::length(sum);
        if (length == 0) return false;
        return std::ranges::all_of(surfels, [&](const format::Surfel& surfel) {
            return radius_of(surfel) > 0 && glm::dot(vector(decode_octahedral(surfel.normal)), sum) >= kAgree * length;
        });
    }

    format::Surfel merged() {
        glm::vec3 normal(0), shading(0), colour(0);
        float area = 0;
        for (const format::Surfel& surfel : surfels) {
            const float weight = radius_of(surfel) * radius_of(surfel);
            const Frame frame = frame_of(surfel.normal);
            const auto& bend = surfel.shading_bend;
            normal += weight * frame.n;
            shading += weight * glm::normalize(frame.n + lean_of(bend[0], 0) * frame.s + lean_of(bend[1], 1) * frame.t);
            for (int c = 0; c < 3; ++c)
                colour[c] += weight * linear_from_srgb(surfel.colour[c]);
            area += weight;
        }
        format::Surfel result{};
        result.patch = surfels.front().patch;
        result.normal = encode_octahedral(normal.x, normal.y, normal.z);
        const Frame frame = frame_of(result.normal);
        const float along = std::max(glm::dot(shading, frame.n), 1e-3f * area);
        result.shading_bend[0] = bend_of(glm::dot(shading, frame.s) / along, 0);
        result.shading_bend[1] = bend_of(glm::dot(shading, frame.t) / along, 1);
        for (int c = 0; c < 3; ++c) {
            result.position[c] = mean[c];
            result.colour[c] = srgb_from_linear(colour[c] / area);
        }
        bound(frame.n, result);
        return result;
    }

  private:
    // Radius and extent: what the disks and their solids reach.
    void bound(const glm::vec3& normal, format::Surfel& result) {
        float radius = 0, lift = 0, epsilon = 0;
        SurfelExtent solid;
        bool flat = true;
        for (const format::Surfel& surfel : surfels) {
            const float own = radius_of(surfel);
            const glm::vec3 offset = position_of(surfel) - mean;
            const float cosine = std::min(glm::dot(vector(decode_octahedral(surfel.normal)), normal), 1.0f);
            const float height = glm::dot(offset, normal), lean = own * std::sqrt(1 - cosine * cosine);
            slant = std::max(slant, lean);
            const SurfelExtent extent = decode_extent(surfel.extent, own);
            radius = std::max(radius, glm::length(offset) + own);
            lift = std::max(lift, std::abs(height) + lean);
            epsilon = std::max(epsilon, extent.epsilon);
            solid.above = std::max(solid.above, height + lean + extent.above);
            solid.below = std::max(solid.below, -height + lean + extent.below);
            flat = flat && extent.above == 0 && extent.below == 0;
        }
        if (flat) solid.above = solid.below = 0;
        // Planes that are tilted against each other leave each other by so much more.
        solid.epsilon = epsilon + lift;
        result.radius = half_at_least(std::min(radius, kLargestHalf));
        result.extent = encode_extent(solid, float_from_half(result.radius));
    }
};

struct Merged {
    std::vector<format::Surfel> records;
    float growth = 0;
};

Merged merge(std::span<const format::Surfel> surfels) {
    Merged merged;
    if (surfels.size() < 2) return merged;
    const float reach = kReach * spacing_of(surfels);
    for (std::size_t first = 0; first < surfels.size();) {
        std::size_t count = 1;
        if (surfels[first].clip == kNoClip)
            while (count < kMost && first + count < surfels.size() && surfels[first + count].clip == kNoClip) {
                const Cluster grown(surfels.subspan(first, count + 1));
                if (!(grown.shift <= reach) || !grown.agrees()) break;
                ++count;
            }
        if (count == 1) {
            merged.records.push_back(surfels[first]);
        } else {
            Cluster cluster(surfels.subspan(first, count));
            merged.records.push_back(cluster.merged());
            float least = std::numeric_limits<float>::infinity();
            for (const format::Surfel& surfel : cluster.surfels)
                least = std::min(least, radius_of(surfel));
            merged.growth =
                std::max({merged.growth, cluster.shift, cluster.slant, radius_of(merged.records.back()) - least});
        }
        first += count;
    }
    return merged;
}

}  // namespace

MergedSurfels merge_surfels(std::span<const format::Surfel> surfels, std::span<const format::Patch> patches) {
    MergedSurfels result;
    std::vector<Merged> finer(patches.size());
    std::vector<std::size_t> kept(patches.size());  // what is finer and in a level
    for (std::size_t i = 0; i < patches.size(); ++i)
        kept[i] = patches[i].surfel_count;
    for (std::size_t round = 0; round < kRounds; ++round) {
        tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t i) {
            const format::Patch& patch = patches[i];
            Merged merged = merge(round == 0 ? surfels.subspan(patch.first_surfel, patch.surfel_count)
                                             : std::span<const format::Surfel>(finer[i].records));
            merged.growth += finer[i].growth;
            finer[i] = std::move(merged);
        });
        std::vector<MergedRange> ranges(patches.size());
        bool any = false;
        for (std::size_t i = 0; i < patches.size(); ++i) {
            const std::vector<format::Surfel>& records = finer[i].records;
            if (static_cast<double>(records.size()) > kWorthwhile * static_cast<double>(kept[i])) continue;
            if (records.empty()) continue;
            any = true;
            kept[i] = records.size();
            ranges[i] = {result.records.size(), static_cast<std::uint32_t>(records.size()), finer[i].growth};
            result.records.insert(result.records.end(), records.begin(), records.end());
        }
        if (any) result.levels.push_back(std::move(ranges));
    }
    return result;
}

}  // namespace splice
