#include "engine/bench/graph/pass_shaders.h"

#include "engine/bench/graph/random.h"
#include "engine/vulkan/transfer.h"
#include "graph_bench_shaders/gather_0_1.h"
#include "graph_bench_shaders/gather_0_2.h"
#include "graph_bench_shaders/gather_1_1.h"
#include "graph_bench_shaders/gather_1_2.h"
#include "graph_bench_shaders/gather_2_1.h"
#include "graph_bench_shaders/gather_2_2.h"
#include "graph_bench_shaders/gather_3_1.h"
#include "graph_bench_shaders/gather_3_2.h"
#include "graph_bench_shaders/rectangle_vert.h"

#include <string>

namespace splice::bench {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

std::vector<gpu::DescriptorBinding> bindings(uint32_t inputs) {
    std::vector<gpu::DescriptorBinding> all{
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT, kMaxSampled}};
    for (uint32_t i = 0; i < inputs; ++i)
        all.push_back({1 + i, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT, 1});
    return all;
}

}  // namespace

PassShaders::PassShaders(gpu::Device& device)
    : device_(&device),
      vertex_(device, rectangle_vert, "rectangle.vert"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      unused_(device, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                       .name = "unused"}) {
    const std::array<std::array<std::span<const uint32_t>, kMaxOutputs>, kMaxInputs + 1> words{
        {{gather_0_1, gather_0_2}, {gather_1_1, gather_1_2}, {gather_2_1, gather_2_2}, {gather_3_1, gather_3_2}}};
    for (uint32_t inputs = 0; inputs <= kMaxInputs; ++inputs) {
        for (uint32_t outputs = 1; outputs <= kMaxOutputs; ++outputs) {
            fragments_[inputs][outputs - 1] = gpu::ShaderModule(device, words[inputs][outputs - 1], "gather.frag");
        }
        set_layouts_[inputs] = gpu::DescriptorSetLayout(device, bindings(inputs));
        layouts_[inputs] =
            gpu::PipelineLayout(device, std::array{set_layouts_[inputs].handle()}, sizeof(Rectangle), kStages);
    }
    VkBufferImageCopy whole{};
    whole.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    whole.imageExtent = {1, 1, 1};
    gpu::upload(device, unused_, std::array<std::byte, 4>{}, std::array{whole});
}

gpu::GraphicsPipelineOptions PassShaders::pipeline_options(const PassShape& shape) const {
    gpu::GraphicsPipelineOptions options;
    options.name = "graph benchmark";
    options.vertex.module = &vertex_;
    if (shape.outputs > 0) options.fragment = {&fragments_[shape.inputs][shape.outputs - 1], {{0, shape.sampled}}};
    options.layout = layout(shape.inputs);
    options.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    options.depth_test = options.depth_write = shape.depth_written;
    for (const bool blended : shape.blended)
        options.blends.push_back(blended ? gpu::Blend::additive() : gpu::Blend::replace());
    return options;
}

void PassShaders::write_set(VkDescriptorSet set, std::span<const ReadImage> sampled,
                            std::span<const ReadImage> inputs) const {
    gpu::DescriptorWriter writer(set);
    for (uint32_t i = 0; i < kMaxSampled; ++i) {
        const ReadImage image = i < sampled.size() ? sampled[i] : ReadImage{unused_.view()};
        writer.sampled_image(0, image.view, sampler_.get(), image.layout, i);
    }
    for (uint32_t i = 0; i < inputs.size(); ++i)
        writer.input_attachment(1 + i, inputs[i].view, inputs[i].layout);
    writer.write(*device_);
}

std::vector<Rectangle> rectangles(uint32_t seed, uint32_t count) {
    Random random(seed);
    const auto next = [&] { return static_cast<float>(random.uniform()); };
    std::vector<Rectangle> all;
    for (uint32_t i = 0; i < count; ++i) {
        Rectangle one{{next(), next(), next(), next()}, 0, 0, 1, 1, next()};
        if (count > 1) {
            one.left = next() * 0.75F;
            one.top = next() * 0.75F;
            one.right = one.left + 0.25F;
            one.bottom = one.top + 0.25F;
        }
        all.push_back(one);
    }
    return all;
}

void draw_rectangles(VkCommandBuffer commands, VkPipelineLayout layout, std::span<const Rectangle> rectangles) {
    for (const Rectangle& rectangle : rectangles) {
        vkCmdPushConstants(commands, layout, kStages, 0, sizeof rectangle, &rectangle);
        vkCmdDraw(commands, 4, 1, 0, 0);
    }
}

}  // namespace splice::bench
