#include "engine/passes/splat_programs.h"

#include "engine/scene/gpu_model.h"
#include "shaders/list_fill_comp.h"
#include "shaders/list_scan_comp.h"
#include "shaders/point_attributes_comp.h"
#include "shaders/point_sums_comp.h"
#include "shaders/point_visibility_comp.h"
#include "shaders/splat_setup_comp.h"
#include "shaders/tile_cells_comp.h"
#include "shaders/tile_gather_comp.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace splice {

namespace {

constexpr VkShaderStageFlags kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
constexpr std::uint64_t kWidestDispatch = 65535;  // workgroups, of every device

}  // namespace

SplatPrograms::SplatPrograms(gpu::Device& device, const FrameData& data, const SplatBuffers& buffers)
    : device_(device),
      data_(data),
      buffers_(buffers),
      surfel_layout_(surfel_set_layout(device)),
      target_layout_(device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kCompute},
                              {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                              {2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                              {3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                              {4, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                              {5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute}}),
      layout_(device,
              std::array{data.layout().handle(), surfel_layout_.handle(), buffers.layout().handle(),
                         target_layout_.handle()},
              sizeof(InstanceConstants), kCompute),
      setup_(device, splat_setup_comp, "splat_setup.comp"),
      cells_(device, tile_cells_comp, "tile_cells.comp"),
      gather_(device, tile_gather_comp, "tile_gather.comp"),
      list_scan_(device, list_scan_comp, "list_scan.comp"),
      list_fill_(device, list_fill_comp, "list_fill.comp"),
      point_visibility_(device, point_visibility_comp, "point_visibility.comp"),
      point_attributes_(device, point_attributes_comp, "point_attributes.comp"),
      point_sums_(device, point_sums_comp, "point_sums.comp"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      pool_(device) {}

std::vector<SplatPrograms::Making> SplatPrograms::begin_making(const FrameSettings& settings,
                                                               std::span<const Program> programs) {
    std::vector<Making> making;
    for (const Program& program : programs) {
        std::shared_future<gpu::ComputePipeline>& pipeline = pipelines_[key_of(settings, program)];
        if (pipeline.valid()) continue;
        making.emplace_back([this, settings, program] { return make(settings, program); });
        pipeline = making.back().get_future().share();
    }
    return making;
}

void SplatPrograms::make_together(const FrameSettings& settings, std::span<const Program> programs) {
    for (Making& making : begin_making(settings, programs))
        makers_.emplace_back(std::move(making));
}

bool SplatPrograms::is_made(const FrameSettings& settings, const Program& program) const {
    const auto known = pipelines_.find(key_of(settings, program));
    return known != pipelines_.end() && known->second.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

const gpu::ComputePipeline& SplatPrograms::pipeline(const FrameSettings& settings, const Program& program) {
    std::shared_future<gpu::ComputePipeline>& pipeline = pipelines_[key_of(settings, program)];
    if (!pipeline.valid())
        for (Making& making : begin_making(settings, std::span(&program, 1)))
            making();
    return pipeline.get();
}

gpu::ComputePipeline SplatPrograms::make(const FrameSettings& settings, const Program& program) const {
    struct Source {
        const gpu::ShaderModule& shader;
        const char* name;
        std::uint32_t part = 0;  // constant 0
    };
    const Variant& variant = program.variant;
    const Source source = [&]() -> Source {
        switch (program.stage) {
            case Stage::kSetup:
                return {setup_, "splat_setup"};
            case Stage::kTileCells:
                return {cells_, "tile_cells"};
            case Stage::kTileGather:
                return {gather_, "tile_gather", 0};
            case Stage::kTileVisibility:
                return {gather_, "tile_visibility", 1};
            case Stage::kTileAttributes:
                return {gather_, "tile_attributes", 2};
            case Stage::kListScan:
                return {list_scan_, "list_scan"};
            case Stage::kListFill:
                return {list_fill_, "list_fill"};
            case Stage::kPointVisibility:
                return {point_visibility_, "point_visibility"};
            case Stage::kPointAttributes:
                return {point_attributes_, "point_attributes"};
            default:
                return {point_sums_, "point_sums", variant.adds ? 1u : 0u};
        }
    }();
    std::map<std::uint32_t, std::uint32_t> constants = frame_constants(settings);
    constants[0] = source.part;
    constants[3] = variant.composes ? 1u : 0u;
    constants[4] = variant.mixed ? 1u : 0u;
    constants[5] = is_deferred(settings) ? 1u : 0u;
    constants[7] = static_cast<std::uint32_t>(variant.cells);
    return {device_, {&source.shader, constants}, layout_.handle(), source.name};
}

void SplatPrograms::bind(const graph::PassContext& context, Stage stage, const FrameSettings& settings,
                         const Variant& variant) {
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline(settings, {stage, variant}).handle());
    const VkDescriptorSet frame_set = data_.set(), splats = buffers_.set();
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 0, 1, &frame_set, 0,
                            nullptr);
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 2, 1, &splats, 0,
                            nullptr);
    if (stage == Stage::kSetup || stage == Stage::kTileCells || stage == Stage::kListScan || stage == Stage::kListFill)
        return;
    const VkDescriptorSet target = target_set(context);
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 3, 1, &target, 0,
                            nullptr);
}

void SplatPrograms::push(VkCommandBuffer commands, const InstanceConstants& constants) const {
    vkCmdPushConstants(commands, layout_.handle(), kCompute, 0, sizeof constants, &constants);
}

void SplatPrograms::bind_surfels(VkCommandBuffer commands, VkDescriptorSet surfels) const {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 1, 1, &surfels, 0, nullptr);
}

void SplatPrograms::dispatch_groups(VkCommandBuffer commands, std::uint64_t groups) {
    vkCmdDispatch(commands, static_cast<std::uint32_t>(std::min(groups, kWidestDispatch)),
                  static_cast<std::uint32_t>((groups + kWidestDispatch - 1) / kWidestDispatch), 1);
}

VkDescriptorSet SplatPrograms::target_set(const graph::PassContext& context) {
    if (sets_.plan_id == context.plan_id && sets_.set != VK_NULL_HANDLE) return sets_.set;
    pool_.reset();  // one frame is in flight, and it is this one
    sets_ = {context.plan_id, pool_.allocate(target_layout_)};
    const FrameTargets& frame = targets_.frame;
    gpu::DescriptorWriter(sets_.set)
        .sampled_image(0, context.depth_view(frame.depth), sampler_.get(),
                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        .storage_image(1, context.view(frame.splat_depth))
        .storage_image(2, context.view(frame.accumulation))
        .storage_image(3, context.view(targets_.deferred ? frame.normals : frame.accumulation))
        .storage_image(4, context.view(targets_.composes ? frame.picture : frame.accumulation))
        .storage_buffer(5, targets_.points ? context.buffer(targets_.point_sums) : buffers_.list().handle())
        .write(device_);
    return sets_.set;
}

}  // namespace splice
