// The attachments that the passes of a frame hand to each other.
#pragma once

#include "engine/render_graph/graph.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace splice {

struct FrameTargets {
    graph::ImageHandle triangle_colour;  // linear; alpha is coverage; unless triangles are drawn to the picture
    graph::ImageHandle depth;            // reversed; stencil 1 where surfels own the pixel
    graph::ImageHandle accumulation;     // (w rgb, w); deferred: albedos
    graph::ImageHandle normals;          // deferred: (w n, w z), view space, z as the depth buffer encodes it
    graph::ImageHandle splat_depth;      // compute: bits of depths in the depth buffer's encoding, the nearest splats'
    graph::ImageHandle picture;
};

/// Stencil values: who owns a pixel.
inline constexpr std::uint32_t kTriangleStencil = 0;  // or nobody
inline constexpr std::uint32_t kSurfelStencil = 1;

/// Passes only where `owner` owns the pixel; writes nothing.
constexpr VkStencilOpState owned_by(std::uint32_t owner) {
    return {.failOp = VK_STENCIL_OP_KEEP,
            .passOp = VK_STENCIL_OP_KEEP,
            .depthFailOp = VK_STENCIL_OP_KEEP,
            .compareOp = VK_COMPARE_OP_EQUAL,
            .compareMask = 0xff,
            .writeMask = 0,
            .reference = owner};
}

}  // namespace splice
