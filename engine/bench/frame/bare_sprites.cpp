#include "engine/bench/frame/bare_sprites.h"

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/passes/surfel_attribute_pass.h"
#include "engine/passes/surfel_primitives.h"
#include "engine/passes/surfel_visibility_pass.h"
#include "engine/vulkan/transfer.h"
#include "shaders/surfel_attribute_frag.h"
#include "shaders/surfel_attribute_vert.h"
#include "shaders/surfel_normalise_frag.h"
#include "shaders/surfel_normalise_vert.h"
#include "shaders/surfel_visibility_frag.h"
#include "shaders/surfel_visibility_vert.h"

#include <array>
#include <chrono>
#include <cstring>

namespace splice::bench {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr std::uint64_t kTexelBytes = 4;
// Attachments, in this order.
constexpr std::uint32_t kTriangles = 0, kDepth = 1, kSums = 2, kPicture = 3;

VkAttachmentDescription attachment(VkFormat format, VkImageLayout final_layout) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    description.finalLayout = final_layout;
    return description;
}

VkSubpassDependency dependency(std::uint32_t source, std::uint32_t destination, VkPipelineStageFlags before,
                               VkAccessFlags wrote, VkPipelineStageFlags after, VkAccessFlags reads) {
    return {source, destination, before, after, wrote, reads, VK_DEPENDENCY_BY_REGION_BIT};
}

gpu::UniqueRenderPass make_render_pass(const gpu::Device& device, VkFormat depth_format) {
    constexpr VkImageLayout kColour = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    constexpr VkImageLayout kDepthRead = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    const std::array attachments{attachment(VK_FORMAT_R16G16B16A16_SFLOAT, kRead), attachment(depth_format, kDepthRead),
                                 attachment(VK_FORMAT_R32G32B32A32_SFLOAT, kRead),
                                 attachment(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)};
    const VkAttachmentReference triangles{kTriangles, kColour}, sums{kSums, kColour}, picture{kPicture, kColour};
    const VkAttachmentReference depth{kDepth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
        depth_read{kDepth, kDepthRead};
    const std::array inputs{VkAttachmentReference{kTriangles, kRead}, VkAttachmentReference{kSums, kRead}, depth_read};
    std::array<VkSubpassDescription, 3> subpasses{};
    subpasses[0].colorAttachmentCount = 1;
    subpasses[0].pColorAttachments = &triangles;
    subpasses[0].pDepthStencilAttachment = &depth;
    subpasses[1].colorAttachmentCount = 1;
    subpasses[1].pColorAttachments = &sums;
    subpasses[1].pDepthStencilAttachment = &depth_read;
    subpasses[2].inputAttachmentCount = static_cast<std::uint32_t>(inputs.size());
    subpasses[2].pInputAttachments = inputs.data();
    subpasses[2].colorAttachmentCount = 1;
    subpasses[2].pColorAttachments = &picture;
    subpasses[2].pDepthStencilAttachment = &depth_read;
    constexpr VkPipelineStageFlags kTests =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkPipelineStageFlags kOutput = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    constexpr VkAccessFlags kWroteColour = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    constexpr VkAccessFlags kWroteDepth = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    constexpr VkPipelineStageFlags kFragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    constexpr VkAccessFlags kReads = VK_ACCESS_INPUT_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    const std::array dependencies{
        dependency(0, 1, kTests, kWroteDepth, kTests, VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT),
        dependency(0, 2, kTests | kOutput, kWroteDepth | kWroteColour, kTests | kFragment, kReads),
        dependency(1, 2, kOutput, kWroteColour, kFragment, VK_ACCESS_INPUT_ATTACHMENT_READ_BIT),
        dependency(2, VK_SUBPASS_EXTERNAL, kOutput, kWroteColour, VK_PIPELINE_STAGE_TRANSFER_BIT,
                   VK_ACCESS_TRANSFER_READ_BIT)};
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = static_cast<std::uint32_t>(subpasses.size());
    info.pSubpasses = subpasses.data();
    info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    VkRenderPass handle = VK_NULL_HANDLE;
    gpu::check(vkCreateRenderPass(device.handle(), &info, nullptr, &handle), "creating a render pass");
    return {device.handle(), handle};
}

}  // namespace

struct BareSprites::Implementation {
    Implementation(const std::string& device_name, const Model& model);
    void resize(std::uint32_t width, std::uint32_t height);
    void make_pipelines(const FrameSettings& frame);
    void record(VkCommandBuffer commands, const FrameSettings& frame);

    gpu::Instance instance;
    gpu::Device device;
    FrameData data;
    std::uint32_t surfel_count;
    gpu::Buffer surfels, pixels;
    VkFormat depth_format;
    gpu::UniqueRenderPass render_pass;
    gpu::UniqueFramebuffer framebuffer;
    std::array<gpu::Image, 4> images;
    gpu::DescriptorSetLayout input_layout;
    gpu::PipelineLayout layout, normalise_layout;
    gpu::DescriptorPool pool;
    VkDescriptorSet inputs = VK_NULL_HANDLE;
    gpu::ShaderModule visibility_vertex, visibility_fragment, attribute_vertex, attribute_fragment, screen_vertex,
        normalise_fragment;
    gpu::GraphicsPipeline visibility, attributes, normalise;
};

BareSprites::Implementation::Implementation(const std::string& device_name, const Model& model)
    : instance(gpu::InstanceOptions{}),
      device(instance, {.choice = gpu::parse_device_choice(device_name)}),
      data(device),
      surfel_count(static_cast<std::uint32_t>(model.surfels.size())),
      surfels(device, {.size = model.surfels.size() * sizeof(format::Surfel),
                       .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                       .name = "surfels"}),
      depth_format(device.depth_stencil_format()),
      render_pass(make_render_pass(device, depth_format)),
      input_layout(device, {{0, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT},
                            {1, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT},
                            {2, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT}}),
      layout(device, std::array{data.layout().handle()}, sizeof(InstanceConstants), kStages),
      normalise_layout(device, std::array{data.layout().handle(), input_layout.handle()}, sizeof(InstanceConstants),
                       kStages),
      pool(device),
      visibility_vertex(device, surfel_visibility_vert, "surfel_visibility.vert"),
      visibility_fragment(device, surfel_visibility_frag, "surfel_visibility.frag"),
      attribute_vertex(device, surfel_attribute_vert, "surfel_attribute.vert"),
      attribute_fragment(device, surfel_attribute_frag, "surfel_attribute.frag"),
      screen_vertex(device, surfel_normalise_vert, "surfel_normalise.vert"),
      normalise_fragment(device, surfel_normalise_frag, "surfel_normalise.frag") {
    gpu::upload(device, surfels, std::as_bytes(std::span(model.surfels)));
}

void BareSprites::Implementation::resize(std::uint32_t width, std::uint32_t height) {
    if (images[kPicture] && images[kPicture].options().width == width && images[kPicture].options().height == height)
        return;
    constexpr VkImageUsageFlags kInput = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
    constexpr VkImageUsageFlags kColour = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    const auto image = [&](VkFormat format, VkImageUsageFlags usage, const char* name) {
        return gpu::Image(device, {.format = format, .width = width, .height = height, .usage = usage, .name = name});
    };
    images[kTriangles] = image(VK_FORMAT_R16G16B16A16_SFLOAT, kColour | kInput, "triangles");
    images[kDepth] = image(depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | kInput, "depth");
    images[kSums] = image(VK_FORMAT_R32G32B32A32_SFLOAT, kColour | kInput, "sums");
    images[kPicture] = image(VK_FORMAT_R8G8B8A8_UNORM, kColour | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "picture");
    pixels = gpu::Buffer(device, {.size = kTexelBytes * width * height,
                                  .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  .memory = gpu::MemoryUse::readback,
                                  .name = "pixels"});
    std::array<VkImageView, 4> views{};
    for (std::size_t i = 0; i < images.size(); ++i)
        views[i] = images[i].view();
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = render_pass.get();
    info.attachmentCount = static_cast<std::uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = width;
    info.height = height;
    info.layers = 1;
    VkFramebuffer handle = VK_NULL_HANDLE;
    gpu::check(vkCreateFramebuffer(device.handle(), &info, nullptr, &handle), "creating a framebuffer");
    framebuffer = {device.handle(), handle};
    pool.reset();
    inputs = pool.allocate(input_layout);
    gpu::DescriptorWriter(inputs)
        .input_attachment(0, views[kTriangles], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        .input_attachment(1, views[kSums], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        .input_attachment(2, images[kDepth].view(VK_IMAGE_ASPECT_DEPTH_BIT),
                          VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        .write(device);
}

void BareSprites::Implementation::make_pipelines(const FrameSettings& frame) {
    if (visibility) return;
    const auto sprites = [&](gpu::GraphicsPipelineOptions options, const gpu::ShaderModule& vertex,
                             const gpu::ShaderModule& fragment, std::uint32_t subpass) {
        options.vertex = {&vertex, frame_constants(frame)};
        options.fragment = {&fragment, frame_constants(frame)};
        options.layout = layout.handle();
        options.render_pass = render_pass.get();
        options.subpass = subpass;
        add_surfel_input(options, false);
        return options;
    };
    gpu::GraphicsPipelineOptions first = sprites(visibility_state(), visibility_vertex, visibility_fragment, 0);
    first.blends = {gpu::Blend::none()};
    visibility = gpu::GraphicsPipeline(device, first);
    attributes =
        gpu::GraphicsPipeline(device, sprites(attribute_state(false), attribute_vertex, attribute_fragment, 1));
    gpu::GraphicsPipelineOptions last;
    last.vertex = {&screen_vertex, {}};
    last.fragment = {&normalise_fragment, frame_constants(frame)};
    last.fragment.constants[0] = 1;
    last.layout = normalise_layout.handle();
    last.render_pass = render_pass.get();
    last.subpass = 2;
    last.stencil_test = true;
    last.stencil_front = last.stencil_back = owned_by(kSurfelStencil);
    last.blends = {gpu::Blend::replace()};
    normalise = gpu::GraphicsPipeline(device, last);
}

void BareSprites::Implementation::record(VkCommandBuffer commands, const FrameSettings& frame) {
    std::array<VkClearValue, 4> clears{};
    clears[kPicture].color = {{1, 1, 1, 0}};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = render_pass.get();
    begin.framebuffer = framebuffer.get();
    begin.renderArea.extent = {frame.width, frame.height};
    begin.clearValueCount = static_cast<std::uint32_t>(clears.size());
    begin.pClearValues = clears.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(frame.width), static_cast<float>(frame.height), 0, 1};
    const VkRect2D scissor{{0, 0}, begin.renderArea.extent};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
    const std::array sets{data.set(), inputs};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.handle(), 0, 1, sets.data(), 0, nullptr);
    InstanceDraws whole;
    whole.model_to_view = view_matrix(frame.camera);
    const InstanceConstants constants = instance_constants(whole, frame.epsilon_scale);
    vkCmdPushConstants(commands, layout.handle(), kStages, 0, sizeof constants, &constants);
    bind_surfels(commands, surfels.handle(), 0, sizeof(format::Surfel));
    for (const gpu::GraphicsPipeline* pipeline : {&visibility, &attributes}) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->handle());
        vkCmdDraw(commands, surfel_count, 1, 0, 0);
        vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, normalise.handle());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, normalise_layout.handle(), 0,
                            static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {frame.width, frame.height, 1};
    vkCmdCopyImageToBuffer(commands, images[kPicture].handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle(),
                           1, &region);
}

BareSprites::BareSprites(const std::string& device, const Model& model)
    : implementation_(std::make_unique<Implementation>(device, model)) {}
BareSprites::~BareSprites() = default;

FrameStats BareSprites::render(const CaptureSettings& settings) {
    Implementation& bare = *implementation_;
    const FrameSettings frame{.width = settings.width,
                              .height = settings.height,
                              .camera = settings.camera,
                              .prefilter = settings.prefilter,
                              .lighting = lighting_flags(Scene{}.lighting)};
    bare.resize(settings.width, settings.height);
    bare.make_pipelines(frame);
    const auto start = std::chrono::steady_clock::now();
    bare.data.update(frame, Scene{}.lighting);
    bare.device.submit_and_wait([&](VkCommandBuffer commands) { bare.record(commands, frame); });
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    FrameStats stats;
    stats.device = bare.device.info().name;
    stats.frame_ms = elapsed.count();
    stats.surfels_drawn = bare.surfel_count;
    return stats;
}

std::vector<std::uint8_t> BareSprites::picture() const {
    const std::span<const std::byte> mapped = implementation_->pixels.mapped();
    std::vector<std::uint8_t> texels(implementation_->pixels.size());
    std::memcpy(texels.data(), mapped.data(), texels.size());
    return texels;
}

}  // namespace splice::bench
