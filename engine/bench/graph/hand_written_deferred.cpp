#include "engine/bench/graph/hand_written_deferred.h"

#include "engine/vulkan/transfer.h"

#include <algorithm>

namespace splice::bench {
namespace {

constexpr VkImageLayout kUndefined = VK_IMAGE_LAYOUT_UNDEFINED;
constexpr VkImageLayout kColour = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kDepth = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kDepthRead = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

constexpr VkPipelineStageFlags2 kOutput = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kTests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

constexpr HandScope kNothing{0, 0};
constexpr HandScope kSampledBefore{kFragment, 0};
constexpr HandScope kSamples{kFragment, VK_ACCESS_2_SHADER_READ_BIT};
constexpr HandScope kReadsInput{kFragment, VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT};
constexpr HandScope kWroteColour{kOutput, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr HandScope kUsesColour{kOutput,
                                VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr HandScope kWroteDepth{kTests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr HandScope kUsesDepth{
    kTests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};

constexpr HandScope operator|(HandScope a, HandScope b) {
    return {a.stages | b.stages, a.access | b.access};
}

constexpr VkAttachmentLoadOp kClear = VK_ATTACHMENT_LOAD_OP_CLEAR, kLoad = VK_ATTACHMENT_LOAD_OP_LOAD,
                             kOverwrite = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
constexpr VkAttachmentStoreOp kStore = VK_ATTACHMENT_STORE_OP_STORE, kForget = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                              kUntouched = VK_ATTACHMENT_STORE_OP_NONE;

constexpr VkImageUsageFlags kColourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
constexpr VkImageUsageFlags kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
constexpr VkImageUsageFlags kSampledUsage = VK_IMAGE_USAGE_SAMPLED_BIT,
                            kInputUsage = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;

}  // namespace

HandWrittenDeferred::HandWrittenDeferred(gpu::Device& device, const PassShaders& shaders, const DeferredView& view,
                                         uint32_t width, uint32_t height, uint32_t objects)
    : device_(&device),
      shaders_(&shaders),
      view_(view),
      width_(width),
      height_(height),
      objects_(objects),
      pool_(device),
      albedo_(&add_image("albedo", VK_FORMAT_R8G8B8A8_UNORM, width, height, kColourUsage | kInputUsage)),
      normal_(&add_image("normal", VK_FORMAT_R16G16B16A16_SFLOAT, width, height,
                         kColourUsage | kInputUsage | kSampledUsage)),
      depth_(&add_image("depth", VK_FORMAT_D32_SFLOAT, width, height, kDepthUsage | kInputUsage | kSampledUsage)),
      light_(&add_image("light", VK_FORMAT_R16G16B16A16_SFLOAT, width, height,
                        kColourUsage | kInputUsage | kSampledUsage)),
      occlusion_(&add_image("occlusion", VK_FORMAT_R8_UNORM, width, height, kColourUsage | kSampledUsage)),
      picture_(&add_image("picture", VK_FORMAT_R8G8B8A8_UNORM, width, height,
                          kColourUsage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)),
      bloom_{light_} {
    for (uint32_t light = 0; light < view.lights; ++light) {
        const uint32_t side = std::min(kShadowMapSize, width);
        shadows_.push_back(&add_image("shadow", VK_FORMAT_D16_UNORM, side, side, kDepthUsage | kSampledUsage));
    }
    for (uint32_t level = 1; level <= view.bloom_levels; ++level) {
        bloom_.push_back(&add_image("bloom", VK_FORMAT_R16G16B16A16_SFLOAT, std::max(width >> level, 1U),
                                    std::max(height >> level, 1U), kColourUsage | kSampledUsage));
    }
    for (uint32_t light = 0; light < view.lights; ++light)
        draw_shadow(light);
    draw_geometry_and_lights();
    find_occlusion();
    if (view.blur_occlusion) blur_occlusion();
    add_ambient();
    for (uint32_t level = 1; level <= view.bloom_levels; ++level)
        shrink(level);
    for (uint32_t level = view.bloom_levels; level > 1; --level)
        grow(level);
    grow_and_map_tones();
    final_barriers_ = {hand_barrier(*picture_, kWroteColour,
                                    {VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT}, kColour,
                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)};
}

const gpu::Image& HandWrittenDeferred::add_image(const std::string& name, VkFormat format, uint32_t width,
                                                 uint32_t height, VkImageUsageFlags usage) {
    images_.emplace_back(
        *device_, gpu::ImageOptions{.format = format, .width = width, .height = height, .usage = usage, .name = name});
    return images_.back();
}

HandStep& HandWrittenDeferred::begin_step(const std::vector<HandAttachment>& attachments,
                                          const std::vector<HandSubpassAttachments>& subpasses,
                                          const std::vector<VkSubpassDependency2>& dependencies) {
    HandStep& step = steps_.emplace_back();
    step.render_pass = hand_render_pass(*device_, attachments, subpasses, dependencies);
    step.framebuffer = hand_framebuffer(*device_, step.render_pass.get(), attachments);
    step.extent = {attachments.front().image->options().width, attachments.front().image->options().height};
    step.clear_values.resize(attachments.size());
    return step;
}

void HandWrittenDeferred::add_subpass(HandStep& step, uint32_t seed, const PassShape& shape,
                                      const std::vector<ReadImage>& sampled, const std::vector<ReadImage>& inputs) {
    gpu::GraphicsPipelineOptions options = shaders_->pipeline_options(shape);
    options.render_pass = step.render_pass.get();
    options.subpass = static_cast<uint32_t>(step.subpasses.size());
    const VkDescriptorSet set = pool_.allocate(shaders_->set_layout(shape.inputs));
    shaders_->write_set(set, sampled, inputs);
    step.subpasses.push_back({gpu::GraphicsPipeline(*device_, options), shaders_->layout(shape.inputs), set,
                              rectangles(seed, shape.depth_written ? objects_ : 1)});
}

void HandWrittenDeferred::draw_shadow(uint32_t light) {
    const gpu::Image& shadow = *shadows_[light];
    HandStep& step = begin_step({{&shadow, kClear, kStore, kDepth, kDepth}}, {{{}, {}, 0}}, {});
    step.barriers = {hand_barrier(shadow, kSampledBefore, kUsesDepth, kUndefined, kDepth)};
    add_subpass(step, 1 + 2 * light, {.depth_written = true}, {}, {});
}

/// Subpass 0 draws the G-buffer, each further one adds a light.
void HandWrittenDeferred::draw_geometry_and_lights() {
    std::vector<HandSubpassAttachments> subpasses{{{0, 1}, {}, 2}};
    std::vector<VkSubpassDependency2> dependencies;
    for (uint32_t light = 0; light < view_.lights; ++light) {
        subpasses.push_back({{3}, {0, 1, 2}, -1});
        dependencies.push_back(hand_dependency(0, light + 1, kWroteColour | kWroteDepth, kReadsInput));
        if (light > 0) dependencies.push_back(hand_dependency(light, light + 1, kWroteColour, kUsesColour));
    }
    // The stores at the end of the last subpass come after the reads of the others.
    for (uint32_t light = 0; light + 1 < view_.lights; ++light)
        dependencies.push_back(hand_dependency(light + 1, view_.lights, kSampledBefore, kWroteColour | kWroteDepth));
    HandStep& step = begin_step({{albedo_, kClear, kStore, kColour, kRead},
                                 {normal_, kClear, kStore, kColour, kRead},
                                 {depth_, kClear, kStore, kDepth, kDepthRead},
                                 {light_, kClear, kStore, kColour, kColour}},
                                subpasses, dependencies);
    step.barriers = {
        hand_barrier(*albedo_, kWroteColour | kSampledBefore, kUsesColour | kReadsInput, kUndefined, kColour),
        hand_barrier(*normal_, kSampledBefore, kUsesColour | kReadsInput, kUndefined, kColour),
        hand_barrier(*depth_, kSampledBefore, kUsesDepth | kReadsInput, kUndefined, kDepth),
        hand_barrier(*light_, kWroteColour | kSampledBefore, kUsesColour, kUndefined, kColour)};
    for (const gpu::Image* shadow : shadows_)
        step.barriers.push_back(hand_barrier(*shadow, kWroteDepth, kSamples, kDepth, kDepthRead));

    add_subpass(step, 0, {.outputs = 2, .depth_written = true, .blended = {false, false}}, {}, {});
    const std::vector<ReadImage> inputs{{albedo_->view()}, {normal_->view()}, {depth_->view(), kDepthRead}};
    for (uint32_t light = 0; light < view_.lights; ++light) {
        add_subpass(step, 2 + 2 * light, {.sampled = 1, .inputs = 3, .outputs = 1, .blended = {light > 0}},
                    {{shadows_[light]->view(), kDepthRead}}, inputs);
    }
}

void HandWrittenDeferred::find_occlusion() {
    HandStep& step = begin_step({{occlusion_, kOverwrite, kStore, kColour, kColour}}, {{{0}, {}, -1}}, {});
    step.barriers = {hand_barrier(*normal_, kWroteColour | kSampledBefore, kSamples, kRead, kRead),
                     hand_barrier(*depth_, kWroteDepth | kSampledBefore, kSamples, kDepthRead, kDepthRead),
                     hand_barrier(*occlusion_, kSampledBefore, kUsesColour, kUndefined, kColour)};
    add_subpass(step, 1 + 2 * view_.lights, {.sampled = 2, .outputs = 1, .blended = {false}},
                {{depth_->view(), kDepthRead}, {normal_->view()}}, {});
}

void HandWrittenDeferred::blur_occlusion() {
    blurred_ = &add_image("blurred occlusion", VK_FORMAT_R8_UNORM, width_, height_, kColourUsage | kSampledUsage);
    HandStep& step = begin_step({{blurred_, kOverwrite, kStore, kColour, kColour}}, {{{0}, {}, -1}}, {});
    step.barriers = {hand_barrier(*occlusion_, kWroteColour, kSamples, kColour, kRead),
                     hand_barrier(*blurred_, kSampledBefore, kUsesColour, kUndefined, kColour)};
    add_subpass(step, 2 + 2 * view_.lights, {.sampled = 1, .outputs = 1, .blended = {false}}, {{occlusion_->view()}},
                {});
}

void HandWrittenDeferred::add_ambient() {
    const gpu::Image& occlusion = blurred_ ? *blurred_ : *occlusion_;
    HandStep& step = begin_step({{light_, kLoad, kStore, kColour, kColour}, {albedo_, kLoad, kUntouched, kRead, kRead}},
                                {{{0}, {1}, -1}}, {});
    step.barriers = {hand_barrier(*albedo_, kWroteColour | kSampledBefore, kUsesColour | kReadsInput, kRead, kRead),
                     hand_barrier(*light_, kWroteColour, kUsesColour, kColour, kColour),
                     hand_barrier(occlusion, kWroteColour, kSamples, kColour, kRead)};
    const uint32_t seed = 2 + 2 * view_.lights + (view_.blur_occlusion ? 1 : 0);
    add_subpass(step, seed, {.sampled = 1, .inputs = 1, .outputs = 1, .blended = {true}}, {{occlusion.view()}},
                {{albedo_->view()}});
}

void HandWrittenDeferred::shrink(uint32_t level) {
    HandStep& step = begin_step({{bloom_[level], kOverwrite, kStore, kColour, kColour}}, {{{0}, {}, -1}}, {});
    step.barriers = {hand_barrier(*bloom_[level - 1], kWroteColour, kSamples, kColour, kRead),
                     hand_barrier(*bloom_[level], kSampledBefore, kUsesColour, kUndefined, kColour)};
    const uint32_t seed = 2 + 2 * view_.lights + (view_.blur_occlusion ? 1 : 0) + level;
    add_subpass(step, seed, {.sampled = 1, .outputs = 1, .blended = {false}}, {{bloom_[level - 1]->view()}}, {});
}

void HandWrittenDeferred::grow(uint32_t level) {
    HandStep& step = begin_step({{bloom_[level - 1], kLoad, kStore, kColour, kColour}}, {{{0}, {}, -1}}, {});
    step.barriers = {hand_barrier(*bloom_[level - 1], kSampledBefore, kUsesColour, kRead, kColour),
                     hand_barrier(*bloom_[level], kWroteColour, kSamples, kColour, kRead)};
    const uint32_t first_grown = 2 + 2 * view_.lights + (view_.blur_occlusion ? 1 : 0) + view_.bloom_levels + 1;
    add_subpass(step, first_grown + view_.bloom_levels - level, {.sampled = 1, .outputs = 1, .blended = {true}},
                {{bloom_[level]->view()}}, {});
}

void HandWrittenDeferred::grow_and_map_tones() {
    HandStep& step =
        begin_step({{light_, kLoad, kForget, kColour, kRead}, {picture_, kOverwrite, kStore, kColour, kColour}},
                   {{{0}, {}, -1}, {{1}, {0}, -1}}, {hand_dependency(0, 1, kWroteColour, kReadsInput)});
    step.barriers = {hand_barrier(*light_, kSampledBefore, kUsesColour | kReadsInput, kRead, kColour),
                     hand_barrier(*bloom_[1], kWroteColour, kSamples, kColour, kRead),
                     hand_barrier(*picture_, kNothing, kUsesColour, kUndefined, kColour)};
    const uint32_t last = 2 + 2 * view_.lights + (view_.blur_occlusion ? 1 : 0) + 2 * view_.bloom_levels;
    add_subpass(step, last, {.sampled = 1, .outputs = 1, .blended = {true}}, {{bloom_[1]->view()}}, {});
    add_subpass(step, last + 1, {.inputs = 1, .outputs = 1, .blended = {false}}, {}, {{light_->view()}});
}

void HandWrittenDeferred::record(VkCommandBuffer commands) const {
    for (const HandStep& step : steps_)
        step.record(commands);
    record_barriers(commands, final_barriers_);
}

RecordedCounts HandWrittenDeferred::counts() const {
    RecordedCounts counts;
    for (const HandStep& step : steps_) {
        counts.passes += static_cast<uint32_t>(step.subpasses.size());
        ++counts.render_passes;
        ++counts.barrier_commands;
        counts.barriers += static_cast<uint32_t>(step.barriers.size());
    }
    ++counts.barrier_commands;
    counts.barriers += static_cast<uint32_t>(final_barriers_.size());
    return counts;
}

uint32_t HandWrittenDeferred::commands() const {
    uint32_t count = 1;  // the last barriers
    for (const HandStep& step : steps_)
        count += step.commands();
    return count;
}

std::vector<std::byte> HandWrittenDeferred::results() {
    return gpu::read_back(*device_, *picture_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

}  // namespace splice::bench
