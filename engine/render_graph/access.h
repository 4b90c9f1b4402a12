// The ways in which a pass can use a resource, and what each means to Vulkan.
#pragma once

#include "engine/vulkan/format_aspects.h"

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <iterator>

namespace splice::graph {

enum class PassKind : uint8_t { graphics, compute, transfer };

enum class AccessKind : uint16_t {
    colour_attachment,         ///< written, or blended over what is kept
    depth_stencil_attachment,  ///< tested and written
    depth_stencil_read,        ///< tested only
    input_attachment,          ///< read at the fragment's own pixel
    sampled,
    storage_read,
    storage_write,
    storage_read_write,
    uniform,
    vertex,
    index,
    indirect,
    transfer_read,
    transfer_write,
};

/// What happens to the contents before the pass writes.
enum class ContentsKind : uint16_t { keep, discard, clear };

/// A synchronisation scope. Only stages and accesses of Vulkan 1.0 are used, so that it fits both generations of
/// barriers and the dependencies of subpasses.
struct Scope {
    VkPipelineStageFlags stages = 0;
    VkAccessFlags access = 0;
    friend bool operator==(const Scope&, const Scope&) = default;
    Scope& operator|=(const Scope& other) {
        stages |= other.stages;
        access |= other.access;
        return *this;
    }
};

/// What a use means to Vulkan.
struct AccessTraits {
    const char* description;  ///< "a colour attachment", "an input attachment", ...: for messages
    bool write;
    bool attachment;  ///< in a render pass, at the fragment's own pixel: what subpasses may hand to each other
    bool shader;      ///< by the shader stages that the access names
    VkPipelineStageFlags stages;  ///< unless by shaders
    VkAccessFlags access;
    VkImageLayout layout, depth_layout;  ///< of images with colour, and with depth or stencil
    VkImageUsageFlags image_usage;
    VkBufferUsageFlags buffer_usage;
};

namespace detail {
inline constexpr VkPipelineStageFlags kDepthTests =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
inline constexpr VkAccessFlags kDepthRead = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
inline constexpr VkAccessFlags kDepthWrite = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
inline constexpr VkImageLayout kNoLayout = VK_IMAGE_LAYOUT_UNDEFINED;
inline constexpr VkImageLayout kDepthReadLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;

// In the order of AccessKind. Two rows hide a decision. Reading belongs to every colour attachment: a pass may blend,
// and the graph does not know. Vulkan wants the attachment usage for the read-only depth layout, even of images that
// are never attached.
inline constexpr AccessTraits kAccessTraits[] = {
    {"a colour attachment", true, true, false, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
     VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0},
    {"a depth-stencil attachment", true, true, false, kDepthTests, kDepthRead | kDepthWrite,
     VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0},
    {"a read-only depth-stencil attachment", false, true, false, kDepthTests, kDepthRead, kDepthReadLayout,
     kDepthReadLayout, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0},
    {"an input attachment", false, true, false, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
     VK_ACCESS_INPUT_ATTACHMENT_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kDepthReadLayout,
     VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT, 0},
    {"a sampled image", false, false, true, 0, VK_ACCESS_SHADER_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
     kDepthReadLayout, VK_IMAGE_USAGE_SAMPLED_BIT, 0},
    {"storage that is read", false, false, true, 0, VK_ACCESS_SHADER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL,
     VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {"storage that is written", true, false, true, 0, VK_ACCESS_SHADER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
     VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {"storage that is read and written", true, false, true, 0, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
     VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
    {"a uniform buffer", false, false, true, 0, VK_ACCESS_UNIFORM_READ_BIT, kNoLayout, kNoLayout, 0,
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT},
    {"a vertex buffer", false, false, false, VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT,
     kNoLayout, kNoLayout, 0, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
    {"an index buffer", false, false, false, VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_INDEX_READ_BIT, kNoLayout,
     kNoLayout, 0, VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {"an indirect buffer", false, false, false, VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
     VK_ACCESS_INDIRECT_COMMAND_READ_BIT, kNoLayout, kNoLayout, 0, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {"the source of a transfer", false, false, false, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT,
     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
    {"the target of a transfer", true, false, false, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     VK_BUFFER_USAGE_TRANSFER_DST_BIT},
};
static_assert(std::size(kAccessTraits) == static_cast<size_t>(AccessKind::transfer_write) + 1);
}  // namespace detail

constexpr const AccessTraits& traits_of(AccessKind kind) {
    return detail::kAccessTraits[static_cast<size_t>(kind)];
}
constexpr bool is_write(AccessKind kind) {
    return traits_of(kind).write;
}
constexpr bool is_attachment(AccessKind kind) {
    return traits_of(kind).attachment;
}
constexpr const char* describe(AccessKind kind) {
    return traits_of(kind).description;
}
const char* describe(PassKind kind);

constexpr bool is_depth_stencil(VkFormat format) {
    return gpu::format_aspects(format) != VK_IMAGE_ASPECT_COLOR_BIT;
}

/// Stages and accesses of a use; shader_stages only counts for uses by shaders.
constexpr Scope scope_of(AccessKind kind, VkPipelineStageFlags shader_stages) {
    const AccessTraits& traits = traits_of(kind);
    return {traits.shader ? shader_stages : traits.stages, traits.access};
}
/// The layout that a use needs; depth-stencil images have one layout for all of their reads. UNDEFINED for buffers,
/// whose format is UNDEFINED.
constexpr VkImageLayout layout_of(AccessKind kind, VkFormat format) {
    if (format == VK_FORMAT_UNDEFINED) return VK_IMAGE_LAYOUT_UNDEFINED;
    return is_depth_stencil(format) ? traits_of(kind).depth_layout : traits_of(kind).layout;
}
/// What an image must be created for.
constexpr VkImageUsageFlags image_usage(AccessKind kind, VkFormat format) {
    if (format == VK_FORMAT_UNDEFINED) return 0;
    const bool read_only_depth = layout_of(kind, format) == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    return traits_of(kind).image_usage |
           (read_only_depth ? VkImageUsageFlags{VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT} : 0);
}
/// The part of an access mask that writes.
constexpr VkAccessFlags write_access(VkAccessFlags access) {
    return access & (VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                     VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                     VK_ACCESS_HOST_WRITE_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

/// What loading or clearing an attachment does when its first subpass begins.
Scope load_scope(VkFormat format, VkAttachmentLoadOp load);
/// What storing an attachment does when its last subpass ends. DONT_CARE counts as a write, NONE touches nothing.
Scope store_scope(VkFormat format, VkAttachmentStoreOp store);

}  // namespace splice::graph
