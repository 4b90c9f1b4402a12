#include "engine/render_graph/executor/executor.h"

#include "engine/render_graph/executor/compiled_frame.h"
#include "engine/render_graph/executor/render_pass_cache.h"
#include "engine/vulkan/timestamps.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

namespace splice::graph {

void Bindings::bind(ImageHandle handle, const gpu::Image& image) {
    const gpu::ImageOptions& options = image.options();
    const BoundImage bound{image.handle(), image.view(), image.view(VK_IMAGE_ASPECT_DEPTH_BIT),
                           image.view(VK_IMAGE_ASPECT_STENCIL_BIT), options.usage};
    bind(handle, bound,
         {options.format, options.width, options.height, options.layers, options.mip_levels, options.samples});
}

void Bindings::bind(ImageHandle handle, const BoundImage& image, const ImageDescription& description) {
    entries_.push_back({handle.resource, {image, VK_NULL_HANDLE}, description, {}});
}

void Bindings::bind(BufferHandle handle, const gpu::Buffer& buffer) {
    entries_.push_back({handle.resource, {{}, buffer.handle()}, {}, {buffer.size()}});
}

struct Executor::State {
    /// Times of one frame in flight.
    struct Slot {
        gpu::Timestamps timestamps;
        gpu::PipelineStatistics counts;
        std::vector<std::string> passes;  // as recorded; the strings keep their storage
        std::vector<uint8_t> counted;     // one a pass: it has counts
    };

    State(gpu::Device& device_, const ExecutorOptions& options_)
        : device(&device_), options(options_), render_passes(device_), slots(options_.frames_in_flight) {}

    CompiledFrame& find_or_compile(const Graph& graph);
    void record_barriers(VkCommandBuffer commands, const BarrierBatch& batch);
    void begin_render_pass(VkCommandBuffer commands, const Graph& graph, uint32_t index);
    void record_group(const Graph& graph, const Group& group, PassContext& context, Slot& slot);
    void prepare_queries(VkCommandBuffer commands, Slot& slot);
    void record_pass(const Graph& graph, uint32_t pass, const PassContext& context, Slot& slot);

    gpu::Device* device;
    ExecutorOptions options;
    RenderPassCache render_passes;
    std::vector<std::unique_ptr<CompiledFrame>> frames;
    CompiledFrame* current = nullptr;
    std::vector<Slot> slots;
    ExecutorStatistics statistics;
    uint64_t executions = 0;
    size_t measured = 0;  // passes of this execution
};

namespace {

/// The key decides; the sizes keep a plan from naming passes or resources that the graph does not have, whatever the
/// key is worth.
bool is_of(const CompiledFrame& frame, const Graph& graph) {
    const Declaration &a = frame.declaration(), &b = graph.declaration();
    return frame.key() == graph.key() && a.passes.size() == b.passes.size() && a.accesses.size() == b.accesses.size() &&
           a.resources.size() == b.resources.size();
}

}  // namespace

CompiledFrame& Executor::State::find_or_compile(const Graph& graph) {
    for (const auto& frame : frames) {
        if (!is_of(*frame, graph)) continue;
        assert(frame->declaration() == graph.declaration());
        return *frame;
    }
    if (frames.size() >= std::max(options.max_plans, 1U)) {
        const auto oldest = std::min_element(frames.begin(), frames.end(),
                                             [](const auto& a, const auto& b) { return a->last_used < b->last_used; });
        device->wait_idle();
        frames.erase(oldest);
        current = nullptr;
    }
    const uint64_t render_passes_before = render_passes.created();
    frames.push_back(
        std::make_unique<CompiledFrame>(*device, render_passes, options, graph, statistics.compilations + 1));
    ++statistics.compilations;
    statistics.objects_created += render_passes.created() - render_passes_before;
    return *frames.back();
}

namespace {

void pipeline_barrier(VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                      std::span<const VkBufferMemoryBarrier2> buffers) {
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(images.size());
    dependency.pImageMemoryBarriers = images.data();
    dependency.bufferMemoryBarrierCount = static_cast<uint32_t>(buffers.size());
    dependency.pBufferMemoryBarriers = buffers.data();
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

void Executor::State::record_barriers(VkCommandBuffer commands, const BarrierBatch& batch) {
    if (batch.empty()) return;
    const Plan& plan = current->plan();
    const std::span image_barriers = slice(current->image_barriers(), batch.images);
    const std::span buffer_barriers = slice(current->buffer_barriers(), batch.buffers);
    if (plan.batch_barriers) {
        pipeline_barrier(commands, image_barriers, buffer_barriers);
    } else {
        for (const VkImageMemoryBarrier2& barrier : image_barriers)
            pipeline_barrier(commands, {&barrier, 1}, {});
        for (const VkBufferMemoryBarrier2& barrier : buffer_barriers)
            pipeline_barrier(commands, {}, {&barrier, 1});
    }
    statistics.barrier_commands += plan.batch_barriers ? 1 : batch.images.count + batch.buffers.count;
    statistics.image_barriers += batch.images.count;
    statistics.buffer_barriers += batch.buffers.count;
}

void Executor::State::begin_render_pass(VkCommandBuffer commands, const Graph& graph, uint32_t index) {
    const RenderPass& planned = current->plan().render_passes[index];
    VkRenderPassAttachmentBeginInfo images{};
    images.sType = VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO;
    images.attachmentCount = planned.attachments.count;
    images.pAttachments = current->views(index);
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.pNext = &images;
    begin.renderPass = current->render_pass(index)->get();
    begin.framebuffer = current->framebuffer(index);
    begin.renderArea.extent = {planned.width, planned.height};
    begin.clearValueCount = planned.attachments.count;
    begin.pClearValues = current->clear_values(graph, index);
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    ++statistics.render_passes;
}

/// Queries for each pass of the current plan.
void Executor::State::prepare_queries(VkCommandBuffer commands, Slot& slot) {
    measured = 0;
    if (options.timestamps && device->features().timestamps) {
        if (slot.timestamps.capacity() < statistics.passes + 1) {
            slot.timestamps = gpu::Timestamps(*device, statistics.passes + 1);
            ++statistics.objects_created;
        }
        slot.timestamps.reset(commands);
        slot.timestamps.write(commands);
    }
    if (options.pipeline_statistics && device->features().pipeline_statistics) {
        if (slot.counts.capacity() < std::max(statistics.passes, 1U)) {
            slot.counts = gpu::PipelineStatistics(*device, std::max(statistics.passes, 1U));
            ++statistics.objects_created;
        }
        slot.counts.reset(commands);
    }
    slot.passes.resize(slot.timestamps || slot.counts ? statistics.passes : 0);
    slot.counted.resize(slot.passes.size());
}

void Executor::State::record_pass(const Graph& graph, uint32_t pass, const PassContext& context, Slot& slot) {
    const std::string& name = graph.pass_name(pass);
    const RecordFunction& function = graph.record_function(pass);
    device->begin_label(context.commands, name);
    const bool counted = slot.counts && graph.declaration().passes[pass].kind == PassKind::graphics;
    if (counted) slot.counts.begin(context.commands);
    if (function) function(context);
    if (counted) slot.counts.end(context.commands);
    device->end_label(context.commands);
    if (slot.timestamps) slot.timestamps.write(context.commands);
    if (slot.passes.empty()) return;
    slot.passes[measured] = name;
    slot.counted[measured] = counted ? 1 : 0;
    ++measured;
}

void Executor::State::record_group(const Graph& graph, const Group& group, PassContext& context, Slot& slot) {
    const VkCommandBuffer commands = context.commands;
    const bool graphics = group.render_pass != none;
    if (graphics) {
        begin_render_pass(commands, graph, group.render_pass);
        const RenderPass& planned = current->plan().render_passes[group.render_pass];
        context.render_pass_owner = &current->render_pass(group.render_pass);
        context.render_pass = current->render_pass(group.render_pass)->get();
        context.extent = {planned.width, planned.height};
        context.samples = planned.samples;
    } else {
        context.render_pass = VK_NULL_HANDLE;
        context.extent = {};
    }
    context.subpass = 0;
    for (const uint32_t pass : slice(current->plan().order, group.passes)) {
        if (graphics) {
            if (context.subpass > 0) vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
            const VkViewport viewport{
                0, 0, static_cast<float>(context.extent.width), static_cast<float>(context.extent.height), 0, 1};
            const VkRect2D scissor{{0, 0}, context.extent};
            vkCmdSetViewport(commands, 0, 1, &viewport);
            vkCmdSetScissor(commands, 0, 1, &scissor);
        }
        record_pass(graph, pass, context, slot);
        ++context.subpass;
    }
    if (graphics) vkCmdEndRenderPass(commands);
}

Executor::Executor(gpu::Device& device, const ExecutorOptions& options)
    : state_(std::make_unique<State>(device, options)) {}

Executor::~Executor() = default;

void Executor::prepare(const Graph& graph) {
    state_->current = &state_->find_or_compile(graph);
}

void Executor::execute(const Graph& graph, const Bindings& bindings, VkCommandBuffer commands, uint32_t frame_slot) {
    State& state = *state_;
    if (frame_slot >= state.slots.size()) {
        throw GraphError("frame slot " + std::to_string(frame_slot) + ": the executor has slots 0 to " +
                         std::to_string(state.slots.size() - 1) + "; ask for more in ExecutorOptions");
    }
    state.current = &state.find_or_compile(graph);
    CompiledFrame& frame = *state.current;
    frame.bind(graph, bindings);
    frame.begin_histories(graph, commands, frame.last_used != 0 && frame.last_used == state.executions);
    frame.update();
    frame.last_used = ++state.executions;

    ExecutorStatistics& statistics = state.statistics;
    statistics.passes = static_cast<uint32_t>(frame.plan().order.size());
    statistics.render_passes = statistics.barrier_commands = statistics.image_barriers = 0;
    statistics.buffer_barriers = 0;
    statistics.transient_bytes = frame.transient_bytes();

    State::Slot& slot = state.slots[frame_slot];
    state.prepare_queries(commands, slot);

    PassContext context;
    context.commands = commands;
    context.plan_id = frame.id();
    context.frame_slot = frame_slot;
    context.history_side = frame.history_side();
    context.resources = frame.bound();
    for (const Group& group : frame.plan().groups) {
        state.record_barriers(commands, group.barriers);
        state.record_group(graph, group, context, slot);
    }
    state.record_barriers(commands, frame.plan().final_barriers);
    statistics.objects_created += frame.take_created();
}

const Plan& Executor::plan() const {
    if (!state_->current) throw GraphError("no graph has been executed");
    return state_->current->plan();
}

std::vector<PassTiming> Executor::timings(uint32_t frame_slot) const {
    const State::Slot& slot = state_->slots.at(frame_slot);
    std::vector<PassTiming> timings;
    for (const std::string& pass : slot.passes)
        timings.push_back({pass});
    if (slot.timestamps) {
        const std::vector<double> times = slot.timestamps.read_ms();
        for (size_t i = 0; i < timings.size(); ++i)
            timings[i].gpu_ms = times[i + 1] - times[i];
    }
    if (slot.counts) {
        const std::vector<gpu::PipelineCounts> counts = slot.counts.read();
        for (size_t i = 0, next = 0; i < timings.size(); ++i) {
            if (slot.counted[i]) timings[i].counts = counts[next++];
        }
    }
    return timings;
}

const ExecutorStatistics& Executor::statistics() const {
    return state_->statistics;
}

}  // namespace splice::graph
