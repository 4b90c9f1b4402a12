// What uses of a resource do on a device, and what barriers make of them: the memory model of hazard_checker.h, one
// atom at a time. Written from the Vulkan specification; shares nothing with the compiler.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>
#include <map>
#include <vector>

namespace splice::test {

/// A stage and what it does there.
struct Step {
    VkPipelineStageFlags stage;
    VkAccessFlags reads, writes;
};

inline constexpr VkPipelineStageFlags kColour = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
inline constexpr VkPipelineStageFlags kEarly = VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT;
inline constexpr VkPipelineStageFlags kLate = VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
inline constexpr VkPipelineStageFlags kFragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

/// One step for each stage of the mask.
std::vector<Step> shader_steps(VkPipelineStageFlags stages, VkAccessFlags reads, VkAccessFlags writes);
std::vector<Step> steps_of(const graph::Access& access);
/// What loading or clearing an attachment does.
Step load_step(VkFormat format, VkAttachmentLoadOp load);
bool writes(const std::vector<Step>& steps);
bool used_as_attachment(graph::AccessKind kind);
bool has_depth(VkFormat format);
bool has_stencil(VkFormat format);
VkImageAspectFlags aspects_of(VkFormat format);
/// What an image or a buffer must be created for.
VkImageUsageFlags image_usage_of(graph::AccessKind kind, VkFormat format);
VkBufferUsageFlags buffer_usage_of(graph::AccessKind kind);
bool layout_fits(VkImageLayout layout, graph::AccessKind kind, VkFormat format);

/// What one stage did to a resource, and what is known to come after it.
struct Atom {
    VkPipelineStageFlags stage = 0;
    VkAccessFlags writes = 0;        // 0: a read
    uint32_t subpass = graph::none;  // within the running render pass; none: before it
    bool available = false;          // writes
    // What happens after it, and (writes) what sees it: accesses by stage, everywhere from now on and in one subpass.
    VkPipelineStageFlags after = 0;
    VkPipelineStageFlags chained = 0;  // stages of finished subpasses that came after it: a barrier may wait for those
    std::map<VkPipelineStageFlags, VkAccessFlags> visible;
    std::map<uint32_t, VkPipelineStageFlags> after_in;
    std::map<uint32_t, std::map<VkPipelineStageFlags, VkAccessFlags>> visible_in;

    /// A barrier with these source stages waits for it.
    bool ordered_before(VkPipelineStageFlags stages) const;
    /// Comes before what this stage does, in this subpass (none: outside of render passes).
    bool ordered(VkPipelineStageFlags stage, uint32_t in_subpass) const;
    /// A write that the step sees.
    bool seen_by(const Step& step, uint32_t in_subpass) const;
    /// A barrier is recorded.
    void extend(const graph::Scope& source, const graph::Scope& destination);
    /// A dependency between subpasses takes effect: by region and only for the subpasses named, so it extends order and
    /// visibility in the later one alone.
    void extend(const graph::SubpassDependency& dependency);
    /// What follows the render pass is ordered by stages alone.
    void leave_render_pass();
};

}  // namespace splice::test
