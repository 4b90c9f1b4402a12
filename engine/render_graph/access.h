// The ways in which a pass can use a resource, and what each means to Vulkan.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace splice::graph {

enum class PassKind : uint8_t { graphics, compute, transfer };

enum class AccessKind : uint8_t {
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
enum class ContentsKind : uint8_t { keep, discard, clear };

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

bool is_write(AccessKind kind);
/// In a render pass, at the fragment's own pixel: what subpasses may hand to each other.
bool is_attachment(AccessKind kind);
bool is_depth_stencil(VkFormat format);
/// COLOR, or DEPTH and STENCIL as the format has them.
VkImageAspectFlags aspects_of(VkFormat format);
/// "a colour attachment", "an input attachment", ...: for messages.
const char* describe(AccessKind kind);
const char* describe(PassKind kind);

/// Stages and accesses of a use; shader_stages only counts for uses by shaders.
Scope scope_of(AccessKind kind, VkPipelineStageFlags shader_stages);
/// What loading or clearing an attachment does when its first subpass begins.
Scope load_scope(VkFormat format, VkAttachmentLoadOp load);
/// What storing an attachment does when its last subpass ends. DONT_CARE counts as a write, NONE touches nothing.
Scope store_scope(VkFormat format, VkAttachmentStoreOp store);
/// The layout that a use needs; depth-stencil images have one layout for all of their reads. UNDEFINED for buffers,
/// whose format is UNDEFINED.
VkImageLayout layout_of(AccessKind kind, VkFormat format);
VkImageUsageFlags image_usage(AccessKind kind);
VkBufferUsageFlags buffer_usage(AccessKind kind);
/// The part of an access mask that writes.
VkAccessFlags write_access(VkAccessFlags access);

}  // namespace splice::graph
