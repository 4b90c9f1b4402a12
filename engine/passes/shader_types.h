// What shaders/glsl/include/frame.glsl declares, in C++; tests/engine/test_shader_layouts.cpp compares the two by
// reflection of the compiled shaders.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>

namespace splice {

struct FrameUniforms {
    glm::mat4 projection;
    glm::vec2 viewport;
    float pixel_scale;
    float near_plane;
    float far_plane;
    std::uint32_t prefilter;
    float sample_share;
    float sample_radius;
    glm::vec3 ambient;
    std::uint32_t light_count;
    float specular;
    float shininess;
    float rim;
    float rim_exponent;
    glm::vec4 background;
    std::uint32_t samples_per_side;
    float padding[3];  // std140 rounds the block up to 16 bytes
};
static_assert(sizeof(FrameUniforms) == 160 && offsetof(FrameUniforms, ambient) == 96);

struct LightRecord {
    glm::vec4 vector;
    glm::vec4 colour;
};
static_assert(sizeof(LightRecord) == 32);

/// Constant 6 of frame.glsl.
enum LightingFlags : std::uint32_t {
    kLightingHighlights = 1u << 0,
    kLightingPhong = 1u << 1,
    kLightingRim = 1u << 2,
    kLightingLamps = 1u << 3,
};

enum InstanceFlags : std::uint32_t {
    kInstanceTwoSided = 1u << 0,
    kInstanceFirstSegment = 1u << 1,
    kInstanceLastSegment = 1u << 2,
    kInstanceTiled = 1u << 3,
    kInstanceListed = 1u << 4,
    kInstancePacked = 1u << 5,
};

struct InstanceConstants {
    glm::vec4 model_to_view[3];
    float scale;
    float epsilon_scale;
    std::uint32_t flags;
    std::uint32_t first_patch;
    std::uint32_t first_surfel;
    std::uint32_t surfel_count;
    std::uint32_t first_group;
    std::uint32_t first_word;
    std::uint32_t first_source;
};
static_assert(sizeof(InstanceConstants) == 84);

struct TileUniforms {
    std::uint32_t cells_x;
    std::uint32_t cells_y;
    std::uint32_t cell_shift;
    std::uint32_t words;
    std::uint32_t segmented;
    std::uint32_t first_solid;
    std::uint32_t first_listed;
    std::uint32_t padding[1];  // std140 rounds the block up to 16 bytes
};
static_assert(sizeof(TileUniforms) == 32);

}  // namespace splice
