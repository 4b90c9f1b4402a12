// A disk stands for surface above and below its plane: seen from any side, it covers the pixels whose rays meet the
// part of the cylinder over the disk that holds that surface. Held against an intersection in double precision.
#include "engine/capture/capture.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 160;
// Single precision decides otherwise only where the truth is as close as this, in radii.
constexpr double kUndecided = 3e-3;
// The clip line is met by rays as far as this outside of it: CLIP_SLACK of splat.glsl, pixels.
constexpr double kClipSlack = 1.0 / 128;

/// How near to the disk's axis the ray comes within the solid, in radii. `slack`: by how much farther out than it lies
/// the clip line is taken to be, in radii.
double nearest_to_axis(const Disk& disk, const glm::dvec3& origin, const glm::dvec3& ray, double near_plane,
                       double slack) {
    const double radius = float_from_half(half_at_least(disk.radius));
    const SurfelExtent extent = decode_extent(
        encode_extent({disk.above, disk.below, disk.epsilon}, static_cast<float>(radius)), static_cast<float>(radius));
    const glm::dvec3 n = glm::normalize(glm::dvec3(disk.normal)), from = origin - glm::dvec3(disk.centre);
    const double rise = glm::dot(ray, n), start = glm::dot(from, n);
    const double t0 = (-double{extent.below} - start) / rise, t1 = (double{extent.above} - start) / rise;
    const glm::dvec3 across = from - start * n, along = ray - rise * n;
    const double length2 = std::max(glm::dot(along, along), 1e-30);
    // Depth is t: rays are as long as deep.
    double begin = std::max(std::min(t0, t1), near_plane), end = std::max(t0, t1);
    const SurfelClip clip = decode_clip(disk.clip);
    const auto frame = tangents_of(decode_octahedral(
        encode_octahedral(static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z))));
    const glm::dvec3 outwards = double{clip.x} * glm::dvec3(frame.s[0], frame.s[1], frame.s[2]) +
                                double{clip.y} * glm::dvec3(frame.t[0], frame.t[1], frame.t[2]);
    const double past = glm::dot(outwards, from) - (double{clip.offset} + slack) * radius,
                 change = glm::dot(outwards, ray);
    if (change > 0) end = std::min(end, -past / change);
    if (change < 0) begin = std::max(begin, -past / change);
    if (begin > end || (change == 0 && past > 0)) return std::numeric_limits<double>::infinity();
    const double t = std::clamp(-glm::dot(across, along) / length2, begin, end);
    return glm::length(across + t * along) / radius;
}

struct Ray {
    glm::dvec3 origin, direction;
};

/// Through a point of the window; `scale`: pixels per unit at depth 1, or per unit where rays are parallel.
Ray ray_through(const glm::dvec2& pixel, std::uint32_t size, double scale, bool orthographic) {
    const glm::dvec2 offset((pixel.x - size / 2.0) / scale, -(pixel.y - size / 2.0) / scale);
    if (orthographic) return {glm::dvec3(offset, 0), {0, 0, -1}};
    return {glm::dvec3(0), glm::dvec3(offset, -1)};
}

void check_cover(const Disk& disk, bool orthographic, bool quads, double near_plane = 0.01,
                 std::uint32_t size = kSize) {
    Renderer renderer({});
    HandmadeModel model(true);
    model.add_surfels({disk});
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    CaptureSettings settings;
    settings.width = settings.height = size;
    settings.camera = looking_down_z(near_plane);
    if (orthographic) settings.camera = parallel(settings.camera);
    settings.clip_to_scene = false;
    settings.force_quads = quads;
    settings.want_depth = true;
    const Frame frame = renderer.render(scene, settings);
    const double scale = orthographic ? size / 2.0 : size / 2.0 / std::tan(glm::radians(30.0));
    int covered = 0, wrong_cover = 0, wrong_depth = 0;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const auto nearest_at = [&](const glm::dvec2& moved, double slack) {
                const Ray ray = ray_through(glm::dvec2(x + 0.5, y + 0.5) + moved, size, scale, orthographic);
                return nearest_to_axis(disk, ray.origin, ray.direction, near_plane, slack);
            };
            const double nearest = nearest_at({0, 0}, 0);
            double least = nearest_at({0, 0}, kUndecided);
            for (int k = 0; k < 8 && disk.clip != kNoClip; ++k) {
                const double turn = glm::radians(45.0 * k);
                least = std::min(least, nearest_at(1.1 * kClipSlack * glm::dvec2(std::cos(turn), std::sin(turn)), 0));
            }
            least -= kUndecided;
            const double most = nearest_at({0, 0}, -kUndecided) + kUndecided;
            if (least < 1 && most >= 1) continue;
            const std::size_t i = std::size_t{y} * size + x;
            covered += frame.coverage[i] != 0 ? 1 : 0;
            wrong_cover += (frame.coverage[i] != 0) != (nearest < 1) ? 1 : 0;
            // Somewhere within the solid.
            const double off = std::abs(double{frame.depth[i]} + double{disk.centre.z});
            wrong_depth += frame.coverage[i] != 0 && off > std::hypot(disk.radius, disk.above + disk.below) ? 1 : 0;
        }
    }
    CHECK(covered > 10);
    CHECK(wrong_cover == 0);
    CHECK(wrong_depth == 0);
}

}  // namespace

TEST_CASE("a disk covers the surface that it stands for, from every side") {
    const glm::vec3 normals[] = {{0, 0, 1}, {0, 1, 0}, {1, 0.3f, 0.02f}, {-0.4f, 0.9f, 0.1f}, {0.5f, 0.5f, -0.01f}};
    for (const glm::vec3& normal : normals) {
        for (const bool orthographic : {false, true}) {
            for (const bool quads : {false, true}) {
                CAPTURE(normal.x, normal.y, normal.z, orthographic, quads);
                check_cover({{0.1f, 0.05f, -1.5f}, normal, 0.4f, 0.01f, kRed, 0.12f, 0.05f}, orthographic, quads);
                check_cover({{0.1f, 0.05f, -1.5f}, normal, 0.4f, 0.01f, kRed, 0, 0.2f}, orthographic, quads);
            }
        }
    }
}

TEST_CASE("a disk that is cut by a line shows up to there, thick or flat, from every side") {
    const glm::vec3 normals[] = {{0, 0, 1}, {0, 1, 0.3f}, {1, 0.3f, 0.02f}, {-0.4f, 0.9f, -0.6f}};
    for (const glm::vec3& normal : normals) {
        for (const int direction : {0, 9, 30, 47}) {
            for (const float offset : {0.0f, 0.35f, 0.8f}) {
                const std::uint16_t clip = encode_clip(direction, offset);
                const bool orthographic = direction % 2 != 0, quads = offset > 0.5f;
                CAPTURE(normal.x, normal.y, normal.z, direction, offset);
                check_cover({{0.1f, 0.05f, -1.5f}, normal, 0.4f, 0.01f, kRed, 0.12f, 0.05f, clip}, orthographic, quads);
                check_cover({{0.1f, 0.05f, -1.5f}, normal, 0.4f, 0.01f, kRed, 0, 0, clip}, !orthographic, quads);
            }
        }
    }
}

TEST_CASE("a disk that is as thick as wide shows whole where the disk alone would fit a point") {
    check_cover({{0.02f, 0.01f, -2}, {0, 1, 0.05f}, 0.5f, 0.01f, kRed, 0.5f, 0.5f}, false, false, 0.01, 480);
    check_cover({{0.02f, 0.01f, -2}, {0, 1, 0.05f}, 0.5f, 0.01f, kRed, 0.5f, 0.5f}, true, false, 0.01, 480);
}

TEST_CASE("a thick disk around the near plane covers what lies in front of it") {
    for (const bool orthographic : {false, true}) {
        CAPTURE(orthographic);
        // Facing the eye and crossing by thickness alone; and tilted, with the middle of the solid behind the plane.
        check_cover({{0.02f, 0.01f, -0.05f}, {0, 0, 1}, 0.03f, 0.01f, kRed, 0.025f, 0.03f}, orthographic, false, 0.06);
        check_cover({{0.02f, 0.01f, -0.05f}, {0, 1, 0.1f}, 0.04f, 0.01f, kRed, 0.02f, 0.01f}, orthographic, false,
                    0.04);
    }
}

TEST_CASE("what is met beside a disk yields to the disks around it") {
    Renderer renderer({});
    // A thick green disk seen edge-on in front of a red sheet, and a sheet of its own depth through its middle.
    const Disk thick{{0, 0, -2}, {0, 1, 0}, 0.3f, 0.1f, kGreen, 0.1f, 0.1f};
    const Disk sheet{{0, 0, -2}, {0, 0, 1}, 0.8f, 0.1f, kRed};
    HandmadeModel model(true);
    model.add_surfels({thick, sheet});
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    scene.lighting.ambient = glm::dvec3(1);
    scene.lighting.lights.clear();
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.camera = looking_down_z();
    settings.clip_to_scene = false;
    const Frame frame = renderer.render(scene, settings);
    const std::uint8_t* beside = &frame.rgba[4 * (std::size_t{kSize / 2 + 3} * kSize + kSize / 2)];
    CHECK(beside[0] > 250);
    CHECK(beside[1] < 16);
}
