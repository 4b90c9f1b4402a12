#include "engine/passes/splat_passes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace splice {

namespace {

// Splats of a few pixels, filter included, are cheaper to scatter than to rasterise; the point backend takes larger
// ones.
constexpr double kPointPixels = 5, kMostPointPixels = 16;
constexpr std::uint64_t kPointSumBytes = 8;   // a channel
constexpr std::uint32_t kPointSumsGroup = 8;  // local_size_x and y of point_sums.comp

std::uint32_t divided_up(std::uint64_t value, std::uint64_t by) {
    return static_cast<std::uint32_t>((value + by - 1) / by);
}

// Setup and gathering hand splats round within a subgroup of at least a workgroup's invocations; all sample the depth
// buffer and store the accumulation.
bool supports_setup(const gpu::Device& device) {
    VkPhysicalDeviceSubgroupProperties subgroups{};
    subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &subgroups;
    vkGetPhysicalDeviceProperties2(device.physical(), &properties);
    constexpr VkSubgroupFeatureFlags needed = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                              VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT |
                                              VK_SUBGROUP_FEATURE_VOTE_BIT;
    return subgroups.subgroupSize >= kTileWidth && (subgroups.supportedOperations & needed) == needed &&
           (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
}

bool supports_targets(const gpu::Device& device) {
    const VkFormat accumulation =
        device.first_supported({VK_FORMAT_R32G32B32A32_SFLOAT},
                               VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT);
    const VkFormat depth =
        device.first_supported({device.depth_stencil_format()},
                               VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
    return accumulation != VK_FORMAT_UNDEFINED && depth != VK_FORMAT_UNDEFINED;
}

// Between two dispatches of one pass; between passes the graph does it.
void wait_for_compute(VkCommandBuffer commands) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                         &barrier, 0, nullptr, 0, nullptr);
}

void clear_image(const graph::PassContext& context, graph::ImageHandle image) {
    const VkClearColorValue nothing{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(context.commands, context.image(image), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &nothing, 1,
                         &all);
}

InstanceConstants range_constants(const GroupRange& range) {
    InstanceConstants constants{};
    constants.first_group = range.first;
    constants.surfel_count = range.count;
    return constants;
}

// Pictures of numbers and samples, and those that are lit afterwards, tiles leave to other passes.
bool can_compose(const FrameSettings& settings) {
    return !is_numeric(settings.view) && settings.antialias == 1 && !is_deferred(settings);
}

std::uint64_t point_bytes(const FrameSettings& settings) {
    const std::uint64_t channels = is_deferred(settings) ? 8 : 4;
    return std::uint64_t{settings.width} * settings.height * channels * kPointSumBytes;
}

}  // namespace

SplatPasses::SplatPasses(gpu::Device& device, const FrameData& data, std::uint64_t most_groups)
    : device_(device),
      most_groups_(most_groups),
      supported_(supports_setup(device)),
      tiles_supported_(supports_targets(device)),
      buffers_(device),
      programs_(device, data, buffers_),
      left_out_(device, programs_),
      raster_(device, data, buffers_),
      depth_(device, data) {}

std::optional<Techniques> SplatPasses::choose(Backend wanted, const FrameSettings& settings) const {
    if (!supported_ || wanted == Backend::kSprite) return std::nullopt;
    // Tiles alone do not write the depth buffer, which these views show or test.
    const bool tiles = tiles_supported_ && settings.view != View::kVisibility && settings.view != View::kBoxes;
    const bool points = tiles_supported_ && point_bytes(settings) <= device_.limits().maxStorageBufferRange;
    Technique others = Technique::kRaster;
    if (wanted == Backend::kTile || (wanted == Backend::kAuto && device_.info().is_cpu())) {
        if (!tiles && wanted == Backend::kTile) return std::nullopt;
        if (tiles) others = Technique::kTile;
    }
    return Techniques{points ? Technique::kPoint : others, others};
}

double SplatPasses::default_points_below(Backend wanted) const {
    if (wanted == Backend::kPoint) return kMostPointPixels;
    // Where a processor renders, gathering was faster at every size (docs/benchmarks.md).
    return wanted == Backend::kAuto && !device_.info().is_cpu() ? kPointPixels : 0;
}

// Only tiles can.
bool SplatPasses::composes(const FrameSettings& settings) const {
    return !is_mixed() && can_compose(settings);
}

bool SplatPasses::uses(Technique technique) const {
    return std::any_of(batches_.begin(), batches_.end(),
                       [&](const SplatBatch& batch) { return batch.range(technique).count > 0; });
}

void SplatPasses::plan(const DrawList& draws, const Techniques& techniques, const FrameSettings& settings) {
    SplatPlan planned = plan_splats(draws, techniques, buffers_.most_groups(most_groups_), settings);
    batches_ = std::move(planned.batches);
    groups_ = std::move(planned.groups);
    counts_ = planned.counts;
}

SurfelOwnership SplatPasses::add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                                 const FrameSettings& settings) {
    SplatRoom room;
    for (const SplatBatch& batch : batches_) {
        room.groups = std::max(room.groups, batch.groups);
        room.tiled = std::max<std::uint64_t>(room.tiled, batch.range(Technique::kTile).count);
        room.listed = std::max<std::uint64_t>(room.listed, batch.range(Technique::kRaster).count);
    }
    const bool points = uses(Technique::kPoint);
    buffers_.prepare(settings, room, groups_, is_mixed() || batches_.size() > 1);
    handles_ = buffers_.import(graph, bindings);
    targets.splat_depth = graph.create_image(
        "splat_depth", {.format = VK_FORMAT_R32_UINT, .width = settings.width, .height = settings.height});
    if (points) point_sums_ = graph.create_buffer("point_sums", {point_bytes(settings)});
    programs_.set_targets({.frame = targets,
                           .point_sums = point_sums_,
                           .composes = composes(settings),
                           .deferred = is_deferred(settings),
                           .points = points});
    summed_ = false;
    left_out_.begin_whole();
    return is_mixed() ? add_mixed(graph, targets, settings) : add_tiles(graph, bindings, targets, settings);
}

SurfelOwnership SplatPasses::add_tiles(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                                       const FrameSettings& settings) {
    const Variant variant{.composes = composes(settings), .cells = TileCells::kSegmented};
    if (batches_.size() == 1) {
        const SplatBatch& batch = batches_.front();
        make_gathering(settings, composes(settings));
        add_setup(graph, settings, batch);
        // No cell can hold too much for one go unless the frame does.
        const bool segments =
            batch.groups > kTileFusedGroups && !left_out_.begin(graph, bindings, handles_.cells, settings, variant);
        if (!composes(settings)) add_sum_clear(graph, targets, settings);
        add_gather(graph, targets, settings);
        if (segments)
            add_segments(graph, targets, settings, {Stage::kTileVisibility, Stage::kTileAttributes}, {true, true},
                         variant);
        return SurfelOwnership::kWeight;
    }
    programs_.make_together(settings, segment_programs(variant));
    // All visibility before all attributes: every batch is set up twice, so that one batch's room is enough.
    for (const Stage stage : {Stage::kTileVisibility, Stage::kTileAttributes})
        for (const SplatBatch& batch : batches_) {
            add_setup(graph, settings, batch);
            add_segments(graph, targets, settings, {stage}, {&batch == &batches_.front(), &batch == &batches_.back()},
                         variant);
        }
    return SurfelOwnership::kWeight;
}

void SplatPasses::make_gathering(const FrameSettings& settings, bool composed) {
    const std::array<SplatPrograms::Program, 3> programs{
        {{Stage::kTileGather, {.composes = composed, .cells = TileCells::kOthers}},
         {Stage::kTileGather, {.composes = composed, .cells = TileCells::kClose}},
         {Stage::kSetup, {}}}};
    programs_.make_together(settings, programs);
}

void SplatPasses::make_for(const FrameSettings& settings, const Techniques& techniques) {
    if (techniques.others != Technique::kTile) return;
    make_gathering(settings, can_compose(settings));
}

SurfelOwnership SplatPasses::add_mixed(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings) {
    const Variant variant{.mixed = true, .cells = TileCells::kSegmented};
    const bool tiles = uses(Technique::kTile), points = uses(Technique::kPoint);
    if (tiles) programs_.make_together(settings, segment_programs(variant));
    if (tiles || points) add_point_clear(graph, targets);
    for (const SplatBatch& batch : batches_) {
        add_setup(graph, settings, batch);
        if (batch.range(Technique::kPoint).count > 0)
            add_points(graph, targets, settings, batch.range(Technique::kPoint), Phase::kVisibility);
        if (batch.range(Technique::kTile).count > 0)
            add_segments(graph, targets, settings, {Stage::kTileVisibility}, {true, true}, variant);
        if (batch.range(Technique::kRaster).count > 0) raster_.add_visibility(graph, targets, settings, handles_);
    }
    if (tiles || points) depth_.add(graph, targets);
    // Blending comes first: it clears what the others add to.
    if (uses(Technique::kRaster)) {
        for (const SplatBatch& batch : batches_) {
            if (batch.range(Technique::kRaster).count == 0) continue;
            if (batches_.size() > 1) add_setup(graph, settings, batch);
            raster_.add_attributes(graph, targets, settings, handles_, !summed_);
            summed_ = true;
        }
    }
    if (points) {
        for (const SplatBatch& batch : batches_) {
            if (batch.range(Technique::kPoint).count == 0) continue;
            if (batches_.size() > 1) add_setup(graph, settings, batch);
            add_points(graph, targets, settings, batch.range(Technique::kPoint), Phase::kAttributes);
        }
        add_point_sums(graph, targets, settings);
    }
    if (tiles) {
        for (const SplatBatch& batch : batches_) {
            if (batch.range(Technique::kTile).count == 0) continue;
            if (batches_.size() > 1) add_setup(graph, settings, batch);
            add_segments(graph, targets, settings, {Stage::kTileAttributes}, {!summed_, true}, variant);
            summed_ = true;
        }
    }
    return SurfelOwnership::kStencil;
}

void SplatPasses::add_setup(graph::Graph& graph, const FrameSettings& settings, const SplatBatch& batch) {
    const bool tiled = batch.range(Technique::kTile).count > 0;
    const bool listed = batch.range(Technique::kRaster).count > 0;
    if (tiled) {
        graph::Pass pass = graph.add_pass("tile_clear", graph::PassKind::transfer);
        handles_.masks = pass.transfer_write(handles_.masks, graph::Contents::discard());
        handles_.cells = pass.transfer_write(handles_.cells, graph::Contents::discard());
        pass.record([this](const graph::PassContext& context) { buffers_.clear_tiles(context.commands); });
    }
    {
        graph::Pass pass = graph.add_pass("splat_setup", graph::PassKind::compute);
        handles_.records = pass.storage_write(handles_.records, graph::Contents::discard());
        handles_.blocks = pass.storage_write(handles_.blocks, graph::Contents::discard());
        // One shader serves all techniques: what a batch does not use it could write all the same.
        handles_.masks = pass.storage_read_write(handles_.masks);
        handles_.cells = pass.storage_read_write(handles_.cells);
        handles_.list = pass.storage_write(handles_.list, graph::Contents::discard());
        pass.record([this, &settings, &batch](const graph::PassContext& context) { set_up(context, settings, batch); });
    }
    if (tiled) {
        graph::Pass pass = graph.add_pass("tile_cells", graph::PassKind::compute);
        handles_.cells = pass.storage_read_write(handles_.cells);
        pass.record([this, &settings](const graph::PassContext& context) {
            programs_.bind(context, Stage::kTileCells, settings, {});
            vkCmdDispatch(context.commands, divided_up(buffers_.cells(), kTileCellsGroup), 1, 1);
        });
    }
    if (listed) add_list(graph, settings, batch.range(Technique::kRaster));
}

void SplatPasses::add_list(graph::Graph& graph, const FrameSettings& settings, const GroupRange& range) {
    graph::Pass pass = graph.add_pass("splat_list", graph::PassKind::compute);
    pass.storage_read(handles_.records);
    pass.storage_read(handles_.blocks);
    handles_.list = pass.storage_read_write(handles_.list);
    pass.record([this, &settings, range](const graph::PassContext& context) {
        for (const Stage stage : {Stage::kListScan, Stage::kListFill}) {
            programs_.bind(context, stage, settings, {});
            programs_.push(context.commands, range_constants(range));
            SplatPrograms::dispatch_groups(context.commands, stage == Stage::kListScan ? 1 : range.count);
            if (stage == Stage::kListScan) wait_for_compute(context.commands);
        }
    });
}

void SplatPasses::read_inputs(graph::Pass& pass, const FrameTargets& targets) const {
    pass.storage_read(handles_.records);
    pass.storage_read(handles_.blocks);
    pass.storage_read(handles_.masks);
    pass.storage_read(handles_.cells);
    pass.indirect_buffer(handles_.cells);
    pass.sampled(targets.depth);
}

void SplatPasses::write_sums(graph::Pass& pass, FrameTargets& targets, const FrameSettings& settings, bool fresh) {
    const auto write = [&](graph::ImageHandle& image) {
        image = fresh ? pass.storage_write(image, graph::Contents::discard()) : pass.storage_read_write(image);
    };
    write(targets.accumulation);
    if (is_deferred(settings)) write(targets.normals);
}

void SplatPasses::add_sum_clear(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings) {
    graph::Pass pass = graph.add_pass("sum_clear", graph::PassKind::transfer);
    std::vector<graph::ImageHandle> sums;
    const auto write = [&](graph::ImageHandle& sum) {
        sum = pass.transfer_write(sum, graph::Contents::discard());
        sums.push_back(sum);
    };
    write(targets.accumulation);
    if (is_deferred(settings)) write(targets.normals);
    pass.record([sums = std::move(sums)](const graph::PassContext& context) {
        for (const graph::ImageHandle sum : sums)
            clear_image(context, sum);
    });
}

void SplatPasses::add_gather(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings) {
    graph::Pass pass = graph.add_pass("tile_gather", graph::PassKind::compute);
    read_inputs(pass, targets);
    const bool composed = composes(settings);
    write_sums(pass, targets, settings, composed);
    targets.splat_depth = pass.storage_write(targets.splat_depth, graph::Contents::discard());
    if (composed) targets.picture = pass.storage_write(targets.picture, graph::Contents::keep());
    pass.record([this, &settings, composed](const graph::PassContext& context) {
        for (const TileCells cells : {TileCells::kOthers, TileCells::kClose}) {
            programs_.bind(context, Stage::kTileGather, settings, {.composes = composed, .cells = cells});
            vkCmdDispatchIndirect(context.commands, context.buffer(handles_.cells), tile_dispatch(cells));
        }
    });
}

void SplatPasses::add_segments(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                               std::vector<Stage> stages, Place place, const Variant& variant) {
    graph::Pass pass = graph.add_pass("tile_segments", graph::PassKind::compute);
    read_inputs(pass, targets);
    const bool sees = stages.front() == Stage::kTileVisibility;
    if (variant.mixed) {
        // One shader does both: it could write in either phase what it writes in the other.
        targets.splat_depth = pass.storage_read_write(targets.splat_depth);
        write_sums(pass, targets, settings, sees || place.first);
    } else {
        const bool fresh = place.first && buffers_.uniforms().segmented != 0 && sees;
        write_sums(pass, targets, settings, fresh);
        targets.splat_depth = fresh ? pass.storage_write(targets.splat_depth, graph::Contents::discard())
                                    : pass.storage_read_write(targets.splat_depth);
        if (variant.composes) targets.picture = pass.storage_write(targets.picture, graph::Contents::keep());
    }
    pass.record([this, &settings, stages = std::move(stages), place, variant](const graph::PassContext& context) {
        for (const Stage stage : stages)
            segment(context, settings, stage, place, variant, stage != stages.front());
    });
}

void SplatPasses::add_point_clear(graph::Graph& graph, FrameTargets& targets) {
    graph::Pass pass = graph.add_pass("splat_clear", graph::PassKind::transfer);
    targets.splat_depth = pass.transfer_write(targets.splat_depth, graph::Contents::discard());
    const bool points = uses(Technique::kPoint);
    if (points) point_sums_ = pass.transfer_write(point_sums_, graph::Contents::discard());
    const graph::ImageHandle depth = targets.splat_depth;
    pass.record([this, depth, points](const graph::PassContext& context) {
        clear_image(context, depth);
        if (points) vkCmdFillBuffer(context.commands, context.buffer(point_sums_), 0, VK_WHOLE_SIZE, 0);
    });
}

void SplatPasses::add_points(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                             const GroupRange& range, Phase phase) {
    const bool sees = phase == Phase::kVisibility;
    graph::Pass pass = graph.add_pass(sees ? "point_visibility" : "point_attributes", graph::PassKind::compute);
    pass.storage_read(handles_.records);
    pass.storage_read(handles_.blocks);
    if (sees) {
        targets.splat_depth = pass.storage_read_write(targets.splat_depth);
    } else {
        pass.sampled(targets.depth);
        point_sums_ = pass.storage_read_write(point_sums_);
    }
    pass.record([this, &settings, range, sees](const graph::PassContext& context) {
        programs_.bind(context, sees ? Stage::kPointVisibility : Stage::kPointAttributes, settings, {});
        programs_.push(context.commands, range_constants(range));
        SplatPrograms::dispatch_groups(context.commands, range.count);
    });
}

void SplatPasses::add_point_sums(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings) {
    graph::Pass pass = graph.add_pass("point_sums", graph::PassKind::compute);
    pass.storage_read(point_sums_);
    const Variant variant{.adds = summed_};
    write_sums(pass, targets, settings, !summed_);
    summed_ = true;
    pass.record([this, &settings, variant](const graph::PassContext& context) {
        programs_.bind(context, Stage::kPointSums, settings, variant);
        vkCmdDispatch(context.commands, divided_up(settings.width, kPointSumsGroup),
                      divided_up(settings.height, kPointSumsGroup), 1);
    });
}

void SplatPasses::set_up(const graph::PassContext& context, const FrameSettings& settings, const SplatBatch& batch) {
    programs_.bind(context, Stage::kSetup, settings, {});
    for (const SplatJob& job : batch.jobs) {
        InstanceConstants constants = instance_constants(*job.instance, settings.epsilon_scale);
        constants.surfel_count = job.groups;
        constants.first_group = job.first_group;
        constants.first_source = job.first_source;
        if (job.technique == Technique::kTile) constants.flags |= kInstanceTiled;
        if (job.technique == Technique::kRaster) constants.flags |= kInstanceListed;
        programs_.push(context.commands, constants);
        programs_.bind_surfels(context.commands, job.surfels);
        SplatPrograms::dispatch_groups(context.commands, job.groups);
    }
}

void SplatPasses::segment(const graph::PassContext& context, const FrameSettings& settings, Stage stage, Place place,
                          const Variant& variant, bool waits) {
    programs_.bind(context, stage, settings, variant);
    InstanceConstants constants{};
    for (std::uint32_t word = 0; word < buffers_.uniforms().words; word += kTileSegmentWords) {
        constants.first_word = word;
        constants.flags =
            (place.first && word == 0 ? kInstanceFirstSegment : 0u) |
            (place.last && word + kTileSegmentWords >= buffers_.uniforms().words ? kInstanceLastSegment : 0u);
        programs_.push(context.commands, constants);
        if (waits || word > 0) wait_for_compute(context.commands);
        vkCmdDispatchIndirect(context.commands, context.buffer(handles_.cells), tile_dispatch(TileCells::kSegmented));
    }
}

}  // namespace splice
