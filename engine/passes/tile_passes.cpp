#include "engine/passes/tile_passes.h"

#include "engine/passes/surfel_normalise_pass.h"
#include "engine/scene/gpu_model.h"
#include "shaders/tile_cells_comp.h"
#include "shaders/tile_gather_comp.h"
#include "shaders/tile_setup_comp.h"

#include <algorithm>
#include <array>
#include <utility>

namespace splice {

namespace {

constexpr VkShaderStageFlags kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
constexpr std::uint64_t kWidestDispatch = 65535;  // workgroups, of every device

constexpr std::uint32_t groups(std::uint64_t invocations, std::uint64_t size) {
    return static_cast<std::uint32_t>((invocations + size - 1) / size);
}

// The shaders hand splats round within a subgroup of at least a workgroup's invocations, sample the depth buffer and
// store the accumulation.
bool supports_tiles(const gpu::Device& device) {
    VkPhysicalDeviceSubgroupProperties subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &subgroups;
    vkGetPhysicalDeviceProperties2(device.physical(), &properties);
    constexpr VkSubgroupFeatureFlags needed = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                              VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    const VkFormat accumulation =
        device.first_supported({VK_FORMAT_R32G32B32A32_SFLOAT},
                               VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT);
    const VkFormat depth =
        device.first_supported({device.depth_stencil_format()},
                               VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
    return subgroups.subgroupSize >= kTileWidth && (subgroups.supportedOperations & needed) == needed &&
           (subgroups.supportedStages & kCompute) != 0 && accumulation != VK_FORMAT_UNDEFINED &&
           depth != VK_FORMAT_UNDEFINED;
}

void wait_for_compute(VkCommandBuffer commands) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                         &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace

TilePasses::TilePasses(gpu::Device& device, const FrameData& data, std::uint64_t most_groups)
    : device_(device),
      data_(data),
      most_groups_(most_groups),
      supported_(supports_tiles(device)),
      buffers_(device),
      surfel_layout_(surfel_set_layout(device)),
      tile_layout_(device, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kCompute},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, kCompute},
                            {2, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, kCompute},
                            {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {4, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kCompute},
                            {5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {6, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kCompute},
                            {7, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kCompute},
                            {8, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kCompute},
                            {9, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                            {10, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                            {11, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kCompute},
                            {12, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                            {13, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute}}),
      layout_(device, std::array{data.layout().handle(), surfel_layout_.handle(), tile_layout_.handle()},
              sizeof(InstanceConstants), kCompute),
      setup_(device, tile_setup_comp, "tile_setup.comp"),
      cells_(device, tile_cells_comp, "tile_cells.comp"),
      gather_(device, tile_gather_comp, "tile_gather.comp"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      pool_(device) {}

bool TilePasses::can_draw(const FrameSettings& settings) const {
    // The visibility view shows the depth buffer, which this backend does not write.
    return supported_ && settings.view != View::kVisibility;
}

// Cuts what is to be drawn into batches that fit the buffers.
void TilePasses::plan(const DrawList& draws) {
    const std::uint64_t most = buffers_.most_groups(most_groups_);
    batches_.assign(1, {});
    const auto add_job = [&](const InstanceDraws& instance, VkDescriptorSet set, std::uint64_t first,
                             std::uint64_t count) {
        while (count > 0) {
            if (batches_.back().groups == most) batches_.emplace_back();
            Batch& batch = batches_.back();
            const std::uint64_t part = std::min(count, (most - batch.groups) * kTileGroup);
            batch.jobs.push_back({&instance, set, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(part),
                                  static_cast<std::uint32_t>(batch.groups)});
            batch.groups += groups(part, kTileGroup);
            first += part;
            count -= part;
        }
    };
    for (const InstanceDraws& instance : draws.instances)
        for (const auto* ranges : {&instance.sprites, &instance.quads})
            for (const DrawRange& range : *ranges)
                for (const SurfelChunk& chunk : instance.model->surfel_chunks()) {
                    const std::uint64_t first = std::max(range.first, chunk.first);
                    const std::uint64_t end = std::min(range.first + range.count, chunk.first + chunk.count);
                    if (first < end) add_job(instance, chunk.set, first - chunk.first, end - first);
                }
}

void TilePasses::add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                     const FrameSettings& settings, const Background& background, const DrawList& draws) {
    plan(draws);
    const bool one_batch = batches_.size() == 1;
    buffers_.prepare(settings, batches_.front().groups, !one_batch, empty_picture(settings.view, background));
    handles_ = buffers_.import(graph, bindings);
    targets_ = targets;
    composes_ = composes(settings);
    deferred_ = is_deferred(settings);
    segment_depth_ = graph.create_image(
        "tile_depth", {.format = VK_FORMAT_R32_SFLOAT, .width = settings.width, .height = settings.height});
    if (one_batch) {
        add_batch(graph, settings, batches_.front());
        add_gather(graph, targets, settings);
        // No cell can hold too much for one go unless the frame does.
        if (batches_.front().groups > kTileFusedGroups)
            add_segments(graph, targets, settings, {Stage::kSegmentVisibility, Stage::kSegmentAttributes},
                         {true, true});
        return;
    }
    // All visibility before all attributes: every batch is set up twice, so that one batch's room is enough.
    for (const Stage stage : {Stage::kSegmentVisibility, Stage::kSegmentAttributes})
        for (const Batch& batch : batches_) {
            add_batch(graph, settings, batch);
            add_segments(graph, targets, settings, {stage}, {&batch == &batches_.front(), &batch == &batches_.back()});
        }
}

void TilePasses::add_batch(graph::Graph& graph, const FrameSettings& settings, const Batch& batch) {
    {
        graph::Pass pass = graph.add_pass("tile_clear", graph::PassKind::transfer);
        handles_.masks = pass.transfer_write(handles_.masks, graph::Contents::discard());
        handles_.cells = pass.transfer_write(handles_.cells, graph::Contents::discard());
        pass.record([this](const graph::PassContext& context) { buffers_.clear(context.commands); });
    }
    {
        graph::Pass pass = graph.add_pass("tile_setup", graph::PassKind::compute);
        handles_.records = pass.storage_write(handles_.records, graph::Contents::discard());
        handles_.blocks = pass.storage_write(handles_.blocks, graph::Contents::discard());
        handles_.masks = pass.storage_read_write(handles_.masks);
        handles_.cells = pass.storage_read_write(handles_.cells);
        pass.record([this, &settings, &batch](const graph::PassContext& context) { setup(context, settings, batch); });
    }
    graph::Pass pass = graph.add_pass("tile_cells", graph::PassKind::compute);
    handles_.cells = pass.storage_read_write(handles_.cells);
    pass.record([this, &settings](const graph::PassContext& context) {
        bind(context, Stage::kCells, settings);
        vkCmdDispatch(context.commands, groups(buffers_.cells(), kTileCellsGroup), 1, 1);
    });
}

void TilePasses::read_inputs(graph::Pass& pass, const FrameTargets& targets) const {
    pass.storage_read(handles_.records);
    pass.storage_read(handles_.blocks);
    pass.storage_read(handles_.masks);
    pass.storage_read(handles_.cells);
    pass.indirect_buffer(handles_.cells);
    pass.sampled(targets.depth);
    pass.sampled(targets.triangle_colour);
}

void TilePasses::add_gather(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings) {
    graph::Pass pass = graph.add_pass("tile_gather", graph::PassKind::compute);
    read_inputs(pass, targets);
    write_outputs(pass, targets, settings, true);
    pass.record([this, &settings](const graph::PassContext& context) {
        bind(context, Stage::kGather, settings);
        vkCmdDispatchIndirect(context.commands, context.buffer(handles_.cells), kTileFusedDispatch);
    });
}

void TilePasses::add_segments(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                              std::vector<Stage> stages, Range range) {
    graph::Pass pass = graph.add_pass("tile_segments", graph::PassKind::compute);
    read_inputs(pass, targets);
    const bool fresh = range.first && buffers_.uniforms().segmented != 0 && stages.front() == Stage::kSegmentVisibility;
    write_outputs(pass, targets, settings, fresh);
    pass.record([this, &settings, stages = std::move(stages), range](const graph::PassContext& context) {
        for (const Stage stage : stages)
            segment(context, settings, stage, range);
    });
}

void TilePasses::write_outputs(graph::Pass& pass, FrameTargets& targets, const FrameSettings& settings, bool fresh) {
    const auto write = [&](graph::ImageHandle& image) {
        image = fresh ? pass.storage_write(image, graph::Contents::discard()) : pass.storage_read_write(image);
    };
    write(targets.accumulation);
    write(segment_depth_);
    if (is_deferred(settings)) write(targets.normals);
    if (composes(settings))
        targets.picture =
            pass.storage_write(targets.picture, fresh ? graph::Contents::discard() : graph::Contents::keep());
}

void TilePasses::setup(const graph::PassContext& context, const FrameSettings& settings, const Batch& batch) {
    bind(context, Stage::kSetup, settings);
    for (const Job& job : batch.jobs) {
        InstanceConstants constants = instance_constants(*job.instance, settings.epsilon_scale);
        constants.first_surfel = job.first_surfel;
        constants.surfel_count = job.count;
        constants.first_group = job.first_group;
        vkCmdPushConstants(context.commands, layout_.handle(), kCompute, 0, sizeof constants, &constants);
        vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 1, 1, &job.surfels,
                                0, nullptr);
        const std::uint64_t all = groups(job.count, kTileGroup);
        vkCmdDispatch(context.commands, static_cast<std::uint32_t>(std::min(all, kWidestDispatch)),
                      groups(all, kWidestDispatch), 1);
    }
}

void TilePasses::segment(const graph::PassContext& context, const FrameSettings& settings, Stage stage, Range range) {
    bind(context, stage, settings);
    InstanceConstants constants{};
    for (std::uint32_t word = 0; word < buffers_.uniforms().words; word += kTileSegmentWords) {
        constants.first_word = word;
        constants.flags =
            (range.first && word == 0 ? kInstanceFirstSegment : 0u) |
            (range.last && word + kTileSegmentWords >= buffers_.uniforms().words ? kInstanceLastSegment : 0u);
        vkCmdPushConstants(context.commands, layout_.handle(), kCompute, 0, sizeof constants, &constants);
        vkCmdDispatchIndirect(context.commands, context.buffer(handles_.cells), kTileSegmentedDispatch);
        wait_for_compute(context.commands);
    }
}

void TilePasses::bind(const graph::PassContext& context, Stage stage, const FrameSettings& settings) {
    struct Program {
        const gpu::ShaderModule& shader;
        const char* name;
        std::uint32_t part;  // PART of tile_gather.comp
    };
    const Program program = [&]() -> Program {
        switch (stage) {
            case Stage::kSetup:
                return {setup_, "tile_setup", 0};
            case Stage::kCells:
                return {cells_, "tile_cells", 0};
            case Stage::kSegmentVisibility:
                return {gather_, "tile_visibility", 1};
            case Stage::kSegmentAttributes:
                return {gather_, "tile_attributes", 2};
            default:
                return {gather_, "tile_gather", 0};
        }
    }();
    gpu::ComputePipeline& pipeline = pipelines_[{frame_variant(settings), stage, composes(settings)}];
    if (!pipeline) {
        std::map<std::uint32_t, std::uint32_t> constants = frame_constants(settings);
        constants[0] = program.part;
        constants[3] = composes(settings) ? 1u : 0u;
        constants[5] = is_deferred(settings) ? 1u : 0u;
        pipeline = gpu::ComputePipeline(device_, {&program.shader, constants}, layout_.handle(), program.name);
    }
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    const VkDescriptorSet frame_set = data_.set(), tile = tile_set(context);
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 0, 1, &frame_set, 0,
                            nullptr);
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 2, 1, &tile, 0,
                            nullptr);
}

VkDescriptorSet TilePasses::tile_set(const graph::PassContext& context) {
    if (sets_.plan_id == context.plan_id && sets_.set != VK_NULL_HANDLE) return sets_.set;
    pool_.reset();  // one frame is in flight, and it is this one
    sets_ = {context.plan_id, pool_.allocate(tile_layout_)};
    gpu::DescriptorWriter writer(sets_.set);
    buffers_.write(writer);
    writer
        .sampled_image(8, context.depth_view(targets_.depth), sampler_.get(),
                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        .storage_image(9, context.view(targets_.accumulation))
        .storage_image(10, context.view(segment_depth_))
        .sampled_image(11, context.view(targets_.triangle_colour), sampler_.get())
        .storage_image(12, context.view(composes_ ? targets_.picture : targets_.accumulation))
        .storage_image(13, context.view(deferred_ ? targets_.normals : targets_.accumulation))
        .write(device_);
    return sets_.set;
}

}  // namespace splice
