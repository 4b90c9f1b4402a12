// The result of compile(): plain data that says everything the executor does. Flat arrays and ranges into them, so that
// a plan of thousands of passes costs few allocations; equal declarations and options give equal plans.
#pragma once

#include "engine/render_graph/access.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

constexpr uint32_t none = UINT32_MAX;

struct Range {
    uint32_t first = 0;
    uint32_t count = 0;
    friend bool operator==(const Range&, const Range&) = default;
};

struct ImageBarrier {
    uint32_t resource = 0;
    Scope source, destination;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    friend bool operator==(const ImageBarrier&, const ImageBarrier&) = default;
};

struct BufferBarrier {
    uint32_t resource = 0;
    Scope source, destination;
    friend bool operator==(const BufferBarrier&, const BufferBarrier&) = default;
};

/// Barriers recorded by one command.
struct BarrierBatch {
    Range images;   ///< into Plan::image_barriers
    Range buffers;  ///< into Plan::buffer_barriers
    bool empty() const { return images.count == 0 && buffers.count == 0; }
    friend bool operator==(const BarrierBatch&, const BarrierBatch&) = default;
};

struct Attachment {
    uint32_t resource = 0;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_DONT_CARE, stencil_load = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_DONT_CARE, stencil_store = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkImageLayout initial_layout =
        VK_IMAGE_LAYOUT_UNDEFINED;  ///< of its first subpass: barriers do all transitions before
    VkImageLayout final_layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< of its last subpass
    uint32_t clear_access = none;  ///< the access (into Graph::accesses()) that holds the clear value
    friend bool operator==(const Attachment&, const Attachment&) = default;
};

struct AttachmentReference {
    uint32_t attachment = 0;  ///< index within the render pass
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageAspectFlags aspects = 0;  ///< input attachments
    friend bool operator==(const AttachmentReference&, const AttachmentReference&) = default;
};

struct Subpass {
    uint32_t pass = 0;
    Range colours;        ///< into Plan::references, in order of location
    Range inputs;         ///< into Plan::references, in order of input_attachment_index
    Range depth_stencil;  ///< into Plan::references, at most one
    Range preserved;      ///< into Plan::preserved: attachments of the render pass
    friend bool operator==(const Subpass&, const Subpass&) = default;
};

/// Between two subpasses of one render pass, by region.
struct SubpassDependency {
    uint32_t source = 0, destination = 0;  ///< subpasses, source < destination
    Scope source_scope, destination_scope;
    friend bool operator==(const SubpassDependency&, const SubpassDependency&) = default;
};

struct RenderPass {
    Range attachments;   ///< into Plan::attachments
    Range subpasses;     ///< into Plan::subpasses, one for each pass of the group, in order
    Range dependencies;  ///< into Plan::dependencies
    uint32_t width = 0, height = 0, layers = 1;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    friend bool operator==(const RenderPass&, const RenderPass&) = default;
};

/// Passes recorded together: the subpasses of one render pass, or one compute or transfer pass.
struct Group {
    Range passes;                 ///< into Plan::order
    BarrierBatch barriers;        ///< before the group
    uint32_t render_pass = none;  ///< into Plan::render_passes
    friend bool operator==(const Group&, const Group&) = default;
};

/// The groups in which a resource holds something, both inclusive.
struct Lifetime {
    uint32_t first_group = none;  ///< none: unused
    uint32_t last_group = none;
    friend bool operator==(const Lifetime&, const Lifetime&) = default;
};

struct PlannedResource {
    Lifetime lifetime;
    VkImageUsageFlags image_usage = 0;
    VkBufferUsageFlags buffer_usage = 0;
    /// A transient image that lives in one render pass and is neither loaded nor stored: no memory needed on tilers.
    bool memoryless = false;
    /// The previous half of a history image: the layout that it is in as the frame begins.
    VkImageLayout initial_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    /// Place of a transient resource in the heap of its memory class; `none` when nothing was placed (see compile.h).
    uint32_t heap = none;  ///< into Plan::heaps
    uint64_t offset = 0;   ///< bytes
    uint64_t size = 0;     ///< bytes; 0 when nothing was placed
    friend bool operator==(const PlannedResource&, const PlannedResource&) = default;
};

enum class CullReason : uint8_t {
    writes_nothing,  ///< and has no side effect
    never_read,      ///< nobody reads what it writes
    overwritten,     ///< `other` overwrites what it writes before anyone reads it
    readers_culled,  ///< only culled passes, `other` among them, read what it writes
};

struct CulledPass {
    uint32_t pass = 0;
    CullReason reason = CullReason::never_read;
    uint32_t resource = none;  ///< one that it writes in vain
    uint32_t other = none;     ///< a pass, as the reason says
    friend bool operator==(const CulledPass&, const CulledPass&) = default;
};

enum class UnmergedReason : uint8_t {
    not_pixel_local,  ///< passes hand `resource` over by other means than attachments
    different_size,   ///< the areas that they render to
    different_samples,
    clears_attachment,  ///< the later pass clears or discards `resource`, which the earlier one uses
    different_layouts,  ///< both only read `resource`, but in different layouts
    pass_between,       ///< `other` must run between them
    gave_up,            ///< whether one must was not found out within the effort that keeps compilation linear
    switched_off,       ///< CompileOptions::merge
};

/// Why two graphics passes that share an attachment are not in one render pass.
struct Unmerged {
    uint32_t earlier = 0, later = 0;  ///< passes
    UnmergedReason reason = UnmergedReason::not_pixel_local;
    uint32_t resource = none;
    uint32_t other = none;
    friend bool operator==(const Unmerged&, const Unmerged&) = default;
};

struct Heap {
    uint64_t size = 0;       ///< bytes
    uint64_t alignment = 1;  ///< bytes
    uint32_t memory_type_bits = 0;
    bool images = false;  ///< images and buffers never share a heap
    friend bool operator==(const Heap&, const Heap&) = default;
};

struct Plan {
    std::vector<uint32_t> order;  ///< passes that are kept, as recorded
    std::vector<Group> groups;
    std::vector<RenderPass> render_passes;
    std::vector<Attachment> attachments;
    std::vector<Subpass> subpasses;
    std::vector<AttachmentReference> references;
    std::vector<uint32_t> preserved;
    std::vector<SubpassDependency> dependencies;
    std::vector<ImageBarrier> image_barriers;
    std::vector<BufferBarrier> buffer_barriers;
    BarrierBatch final_barriers;             ///< after the last group: imported resources to their use outside
    bool batch_barriers = true;              ///< a batch is one command; false: each barrier is one
    std::vector<PlannedResource> resources;  ///< one a declared resource
    std::vector<Heap> heaps;
    std::vector<CulledPass> culled;
    std::vector<Unmerged> unmerged;
    friend bool operator==(const Plan&, const Plan&) = default;
};

/// The elements of a range: slice(plan.subpasses, render_pass.subpasses).
template <typename T, typename Allocator>
std::span<const T> slice(const std::vector<T, Allocator>& elements, Range range) {
    return std::span<const T>(elements).subspan(range.first, range.count);
}

}  // namespace splice::graph
