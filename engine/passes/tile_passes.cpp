#include "engine/passes/tile_passes.h"

#include "engine/scene/gpu_model.h"
#include "shaders/tile_count_comp.h"
#include "shaders/tile_gather_comp.h"
#include "shaders/tile_list_comp.h"
#include "shaders/tile_scan_comp.h"
#include "shaders/tile_setup_comp.h"
#include "shaders/tile_starts_comp.h"

#include <algorithm>
#include <array>

namespace splice {

namespace {

constexpr VkShaderStageFlags kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
constexpr std::uint32_t kWidestDispatch = 65535;  // workgroups, of every device

enum TileBinding : std::uint32_t {
    kUniforms,
    kRecords,
    kBounds,
    kCounts,
    kStarts,
    kLists,
    kDepth,
    kAccumulation,
    kReport
};

constexpr std::uint32_t groups(std::uint64_t invocations, std::uint32_t size) {
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

}  // namespace

TilePasses::TilePasses(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      supported_(supports_tiles(device)),
      buffers_(device),
      surfel_layout_(surfel_set_layout(device)),
      tile_layout_(device, {{kUniforms, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kCompute},
                            {kRecords, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {kBounds, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {kCounts, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {kStarts, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {kLists, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute},
                            {kDepth, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kCompute},
                            {kAccumulation, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kCompute},
                            {kReport, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCompute}}),
      layout_(device, std::array{data.layout().handle(), surfel_layout_.handle(), tile_layout_.handle()},
              sizeof(InstanceConstants), kCompute),
      setup_(device, tile_setup_comp, "tile_setup.comp"),
      count_(device, tile_count_comp, "tile_count.comp"),
      scan_(device, tile_scan_comp, "tile_scan.comp"),
      starts_(device, tile_starts_comp, "tile_starts.comp"),
      list_(device, tile_list_comp, "tile_list.comp"),
      gather_(device, tile_gather_comp, "tile_gather.comp"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      pool_(device) {}

std::uint64_t TilePasses::entries_for(const DrawList& draws) const {
    // What the last frame needed is a good guess; of the first one nothing is known.
    return std::max<std::uint64_t>(2 * draws.surfels, buffers_.entries_needed());
}

bool TilePasses::can_draw(const FrameSettings& settings, const DrawList& draws) const {
    // The visibility view shows the depth buffer, which this backend does not write.
    return supported_ && settings.view != View::kVisibility && !is_deferred(settings) &&
           buffers_.fits(settings, draws.surfels, entries_for(draws));
}

void TilePasses::prepare(const FrameSettings& settings, const DrawList& draws) {
    buffers_.prepare(settings, draws.surfels, entries_for(draws));
}

void TilePasses::add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                     const FrameSettings& settings, const DrawList& draws) {
    TileHandles handles = handles_ = buffers_.import(graph, bindings);
    targets_ = targets;
    add_setup(graph, handles, settings, draws);
    add_lists(graph, handles, settings);
    graph::Pass pass = graph.add_pass("tile_gather", graph::PassKind::compute);
    pass.storage_read(handles.records);
    pass.storage_read(handles.starts);
    pass.storage_read(handles.lists);
    pass.sampled(targets.depth);
    targets.accumulation = pass.storage_write(targets.accumulation, graph::Contents::discard());
    pass.record([this, &settings](const graph::PassContext& context) {
        bind(context, gather_, "tile_gather", settings);
        vkCmdDispatch(context.commands, buffers_.uniforms().tiles_x, buffers_.uniforms().tiles_y, 1);
    });
}

void TilePasses::add_setup(graph::Graph& graph, TileHandles& handles, const FrameSettings& settings,
                           const DrawList& draws) {
    graph::Pass pass = graph.add_pass("tile_setup", graph::PassKind::compute);
    handles.records = pass.storage_write(handles.records, graph::Contents::discard());
    handles.bounds = pass.storage_write(handles.bounds, graph::Contents::discard());
    pass.record([this, &settings, &draws](const graph::PassContext& context) { setup(context, settings, draws); });
}

void TilePasses::add_lists(graph::Graph& graph, TileHandles& handles, const FrameSettings& settings) {
    {
        graph::Pass pass = graph.add_pass("tile_clear", graph::PassKind::transfer);
        handles.counts = pass.transfer_write(handles.counts, graph::Contents::discard());
        pass.record([this](const graph::PassContext& context) {
            vkCmdFillBuffer(context.commands, context.buffer(handles_.counts), 0, buffers_.count_bytes(), 0);
        });
    }
    const std::uint32_t chunks = buffers_.uniforms().chunks;
    const std::uint64_t tiles = std::uint64_t{buffers_.uniforms().tiles_x} * buffers_.uniforms().tiles_y;
    {
        graph::Pass pass = graph.add_pass("tile_count", graph::PassKind::compute);
        pass.storage_read(handles.bounds);
        handles.counts = pass.storage_read_write(handles.counts);
        pass.record([this, &settings, chunks](const graph::PassContext& context) {
            bind(context, count_, "tile_count", settings);
            vkCmdDispatch(context.commands, groups(chunks, kChunkGroup), 1, 1);
        });
    }
    {
        graph::Pass pass = graph.add_pass("tile_scan", graph::PassKind::compute);
        handles.counts = pass.storage_read_write(handles.counts);
        handles.starts = pass.storage_write(handles.starts, graph::Contents::discard());
        pass.record([this, &settings, tiles](const graph::PassContext& context) {
            bind(context, scan_, "tile_scan", settings);
            vkCmdDispatch(context.commands, groups(tiles, kScanGroup), 1, 1);
        });
    }
    {
        graph::Pass pass = graph.add_pass("tile_starts", graph::PassKind::compute);
        handles.starts = pass.storage_read_write(handles.starts);
        handles.report = pass.storage_write(handles.report, graph::Contents::discard());
        pass.record([this, &settings](const graph::PassContext& context) {
            bind(context, starts_, "tile_starts", settings);
            vkCmdDispatch(context.commands, 1, 1, 1);
        });
    }
    {
        graph::Pass pass = graph.add_pass("tile_list", graph::PassKind::compute);
        pass.storage_read(handles.bounds);
        pass.storage_read(handles.starts);
        handles.counts = pass.storage_read_write(handles.counts);
        handles.lists = pass.storage_write(handles.lists, graph::Contents::discard());
        pass.record([this, &settings, chunks](const graph::PassContext& context) {
            bind(context, list_, "tile_list", settings);
            vkCmdDispatch(context.commands, groups(chunks, kChunkGroup), 1, 1);
        });
    }
}

void TilePasses::setup(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws) {
    bind(context, setup_, "tile_setup", settings);
    std::uint32_t splat = 0;
    for (const InstanceDraws& instance : draws.instances) {
        InstanceConstants constants = instance_constants(instance, settings.epsilon_scale);
        for (const auto* ranges : {&instance.sprites, &instance.quads}) {
            for (const DrawRange& range : *ranges) {
                for (const SurfelChunk& chunk : instance.model->surfel_chunks()) {
                    const std::uint64_t first = std::max(range.first, chunk.first);
                    const std::uint64_t end = std::min(range.first + range.count, chunk.first + chunk.count);
                    if (first >= end) continue;
                    constants.first_surfel = static_cast<std::uint32_t>(first - chunk.first);
                    constants.surfel_count = static_cast<std::uint32_t>(end - first);
                    constants.first_splat = splat;
                    splat += constants.surfel_count;
                    vkCmdPushConstants(context.commands, layout_.handle(), kCompute, 0, sizeof constants, &constants);
                    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.handle(), 1, 1,
                                            &chunk.set, 0, nullptr);
                    const std::uint32_t all = groups(constants.surfel_count, kSetupShare);
                    vkCmdDispatch(context.commands, std::min(all, kWidestDispatch), groups(all, kWidestDispatch), 1);
                }
            }
        }
    }
}

void TilePasses::bind(const graph::PassContext& context, const gpu::ShaderModule& shader, const char* name,
                      const FrameSettings& settings) {
    gpu::ComputePipeline& pipeline = pipelines_[{frame_variant(settings), name}];
    if (!pipeline)
        pipeline = gpu::ComputePipeline(device_, {&shader, frame_constants(settings)}, layout_.handle(), name);
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
    gpu::DescriptorWriter(sets_.set)
        .uniform_buffer(kUniforms, buffers_.uniform_buffer().handle())
        .storage_buffer(kRecords, context.buffer(handles_.records))
        .storage_buffer(kBounds, context.buffer(handles_.bounds))
        .storage_buffer(kCounts, context.buffer(handles_.counts))
        .storage_buffer(kStarts, context.buffer(handles_.starts))
        .storage_buffer(kLists, context.buffer(handles_.lists))
        .sampled_image(kDepth, context.depth_view(targets_.depth), sampler_.get(),
                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        .storage_image(kAccumulation, context.view(targets_.accumulation))
        .storage_buffer(kReport, context.buffer(handles_.report))
        .write(device_);
    return sets_.set;
}

}  // namespace splice
