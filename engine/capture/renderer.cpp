#include "engine/capture/capture.h"
#include "engine/capture/numeric_picture.h"
#include "engine/passes/copy_pass.h"
#include "engine/passes/frame.h"
#include "engine/passes/read_back_pass.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/scene/cut_store.h"
#include "engine/scene/frame_budget.h"
#include "engine/scene/gpu_model.h"
#include "engine/scene/settle_pages.h"
#include "engine/vulkan/transfer.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>

namespace splice {

struct Renderer::Implementation {
    explicit Implementation(const RendererOptions& options)
        : own(std::make_unique<OwnDevice>(options)),
          device(own->device),
          executor(device, options.graph),
          passes(device, options.most_splat_groups),
          cut_store(device) {}
    explicit Implementation(gpu::Device& borrowed)
        : device(borrowed), executor(device), passes(device), cut_store(device) {}

    // What becomes of the picture: passes that read it.
    using UsePicture = std::function<void(graph::Bindings&, graph::ImageHandle)>;
    static FrameSettings frame_settings(const CaptureSettings& settings, const Camera& camera, View view,
                                        const Lighting& lighting);
    void draw(const Scene& scene, const CaptureSettings& settings, const Camera& camera, View view,
              const UsePicture& use_picture, FrameStats* stats);
    std::vector<std::byte> render_raw(const Scene& scene, const CaptureSettings& settings, const Camera& camera,
                                      View view, FrameStats* stats);
    void reserve_pixels(std::uint64_t bytes);

    struct OwnDevice {
        explicit OwnDevice(const RendererOptions& options)
            : instance({.validate = options.validate}),
              device(instance, {.choice = gpu::parse_device_choice(options.device)}) {}
        gpu::Instance instance;
        gpu::Device device;
    };

    std::unique_ptr<OwnDevice> own;  // null: the device is somebody else's
    gpu::Device& device;
    graph::Executor executor;
    FramePasses passes;
    CutStore cut_store;
    graph::Graph graph;
    gpu::Buffer pixels;
};

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

constexpr double kSmallBox = 80;  // pixels: see node_boxes()

constexpr std::uint64_t kTexelBytes = 4;  // of both picture formats

std::array<VkBufferImageCopy, 1> whole_image(const CaptureSettings& settings) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {settings.width, settings.height, 1};
    return {region};
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

void count_overlap(FrameStats& stats, const std::vector<float>& counts) {
    double sum = 0;
    std::uint64_t pixels = 0;
    for (const float count : counts) {
        if (!std::isfinite(count) || count <= 0) continue;
        sum += count;
        ++pixels;
    }
    stats.overlap_mean = pixels == 0 ? 0 : sum / static_cast<double>(pixels);
    stats.fragments = static_cast<std::uint64_t>(sum);
}

std::uint8_t encoded(double channel) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0, 1.0) * 255));
}

void check_settings(const CaptureSettings& settings, const VkPhysicalDeviceLimits& limits) {
    const std::uint32_t most =
        std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxImageDimension2D});
    if (settings.width == 0 || settings.height == 0 || settings.width > most || settings.height > most)
        throw UsageError("a picture of " + std::to_string(settings.width) + "x" + std::to_string(settings.height) +
                         " pixels: each side must be 1 to " + std::to_string(most) + " on this device");
    if (settings.antialias == 0 || std::max(settings.width, settings.height) > most / settings.antialias)
        throw UsageError("a picture of " + std::to_string(settings.width) + "x" + std::to_string(settings.height) +
                         " pixels with " + std::to_string(settings.antialias) +
                         " samples along each: a side must be 1 to " + std::to_string(most) +
                         " samples on this device");
}

// What is drawn, and the tau that chose it, in samples.
BudgetedDraws select(const Scene& scene, const CaptureSettings& settings, const Camera& camera,
                     const DrawListOptions& options, std::uint32_t width, std::uint32_t height) {
    const auto build = [&](const Camera& from, const DrawListOptions& how) {
        if (settings.budget_ms) return build_within_budget(scene, from, width, height, how, *settings.budget_ms);
        return BudgetedDraws{how.tau, build_draw_list(scene, from, width, height, how)};
    };
    if (!settings.cut_camera) return build(camera, options);
    // What was chosen from elsewhere may be anywhere, and of any size: too large for a point.
    DrawListOptions anywhere = options;
    anywhere.force_quads = true;
    anywhere.small_px = 0;
    Camera from = *settings.cut_camera;
    if (settings.clip_to_scene) fit_clip_planes(from, scene.drawn_bounds());
    BudgetedDraws chosen = build(from, anywhere);
    look_from(chosen.draws, scene, camera);
    return chosen;
}

ResidentBytes resident_bytes(const Scene& scene, const CutStore& gathered, gpu::Device& device) {
    ResidentBytes bytes{.surfels = gathered.bytes(), .device = device.memory().statistics().allocated_bytes};
    std::set<const GpuModel*> models;
    for (const Instance& instance : scene.instances)
        models.insert(instance.model.get());
    for (const GpuModel* model : models) {
        bytes.surfels += model->surfels().buffer().size();
        if (model->pager() != nullptr) bytes.surfels += model->pager()->resident_bytes();
        bytes.triangles += model->vertices().size() + model->indices().size();
    }
    return bytes;
}

}  // namespace

void Renderer::Implementation::reserve_pixels(std::uint64_t bytes) {
    if (pixels && pixels.size() == bytes) return;
    pixels = gpu::Buffer(device, {.size = bytes,
                                  .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  .memory = gpu::MemoryUse::readback,
                                  .name = "pixels"});
}

FrameSettings Renderer::Implementation::frame_settings(const CaptureSettings& settings, const Camera& camera, View view,
                                                       const Lighting& lighting) {
    const std::uint32_t antialias = is_numeric(view) ? 1 : settings.antialias;
    return {.width = settings.width * antialias,
            .height = settings.height * antialias,
            .antialias = antialias,
            .camera = camera,
            .view = view,
            .epsilon_scale = settings.epsilon_scale,
            .prefilter = settings.prefilter,
            .kernel = settings.kernel,
            .shading = settings.shading,
            .cull_groups = settings.cull_groups,
            .lighting = lighting_flags(lighting)};
}

void Renderer::Implementation::draw(const Scene& scene, const CaptureSettings& settings, const Camera& camera,
                                    View view, const UsePicture& use_picture, FrameStats* stats) {
    const auto start = Clock::now();
    const FrameSettings frame = frame_settings(settings, camera, view, scene.lighting);
    const std::uint32_t antialias = frame.antialias;
    const SurfelBackend backend = choose_backend(settings.backend, settings.points_below, passes, frame);
    const DrawListOptions list_options{
        .sides = settings.sides,
        .draw_triangles = settings.draw_triangles && settings.shown != Shown::kSurfels &&
                          settings.view != View::kSurfelsOnly && settings.view != View::kSamples,
        .draw_surfels = settings.draw_surfels && settings.view != View::kTrianglesOnly,
        .surfels_as_triangles = settings.shown == Shown::kTriangles,
        .label_levels = view == View::kLevels,
        .merge_patches = view != View::kPatches,
        .force_quads = settings.force_quads,
        .cull_groups = settings.cull_groups,
        .max_point_size = device.features().large_points ? static_cast<double>(device.limits().pointSizeRange[1]) : 0,
        .small_px = backend.small_px,
        .boxes_px = view == View::kBoxes ? kSmallBox * antialias : 0,
        .merge_px = view == View::kSamples ? 0 : settings.merge_px,
        .tau = settings.tau * antialias,
        .costs = settings.costs};
    auto [tau, draws] = select(scene, settings, camera, list_options, frame.width, frame.height);
    tau /= antialias;
    const auto selected = Clock::now();
    const PageStats pages = settle_pages(draws, settings.wait_for_data);
    cut_store.gather(draws, view == View::kLevels);
    if (list_options.merge_patches && !list_options.label_levels) cut_store.gather_triangles(draws);
    const auto gathered = Clock::now();
    passes.data.update(frame, scene.lighting, scene.background);

    do {
        graph.clear();
        graph::Bindings bindings;
        use_picture(bindings, add_frame(graph, bindings, passes, backend, frame, scene.background, draws));
        device.submit_and_wait([&](VkCommandBuffer commands) { executor.execute(graph, bindings, commands); });
    } while (passes.splats.make_lacking());

    if (!stats) return;
    stats->frame_ms = milliseconds(start, Clock::now());
    stats->load = draws.load;
    stats->predicted_ms = draws.predicted_ms;
    stats->costs = settings.costs;
    stats->cut = {.tau = tau,
                  .counts = draws.cut,
                  .budget_ms = settings.budget_ms,
                  .select_ms = milliseconds(start, selected),
                  .gather_ms = milliseconds(selected, gathered)};
    for (const graph::PassTiming& timing : executor.timings())
        stats->passes.push_back({timing.name, timing.gpu_ms, timing.counts});
    for (const BackendShare& share : backend_shares(backend, draws)) {
        if (stats->drawn_by.empty() || share.surfels > stats->drawn_by.front().surfels) stats->backend = share.backend;
        stats->drawn_by.push_back({share.backend, share.surfels});
    }
    stats->pages = pages;
    stats->patches = draws.patches;
    stats->resident = resident_bytes(scene, cut_store, device);
    stats->antialias = antialias;
    stats->shading = settings.shading;
    stats->surfels_drawn = draws.surfels;
    stats->merged = draws.merged;
    if (backend.techniques) stats->setup = passes.splats.counts();
    stats->triangles_drawn = draws.triangles;
}

std::vector<std::byte> Renderer::Implementation::render_raw(const Scene& scene, const CaptureSettings& settings,
                                                            const Camera& camera, View view, FrameStats* stats) {
    reserve_pixels(kTexelBytes * settings.width * settings.height);
    const auto read_back = [&](graph::Bindings& bindings, graph::ImageHandle picture) {
        const graph::BufferHandle destination =
            graph.import_buffer("pixels", {pixels.size()}, {.after = graph::external::host_read()});
        add_read_back(graph, picture, destination, settings.width, settings.height);
        bindings.bind(destination, pixels);
    };
    draw(scene, settings, camera, view, read_back, stats);
    const std::span<const std::byte> mapped = pixels.mapped();
    return {mapped.begin(), mapped.begin() + static_cast<std::ptrdiff_t>(pixels.size())};
}

Renderer::Renderer(const RendererOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Renderer::Renderer(gpu::Device& device) : implementation_(std::make_unique<Implementation>(device)) {}
Renderer::~Renderer() = default;

std::shared_ptr<const GpuModel> Renderer::load(const ModelView& model, const Paging& paging) {
    return std::make_shared<const GpuModel>(implementation_->device, model, paging);
}

void Renderer::make_for(const CaptureSettings& settings, const Lighting& lighting) {
    Implementation& engine = *implementation_;
    const FrameSettings frame = Implementation::frame_settings(settings, settings.camera, settings.view, lighting);
    const SurfelBackend backend = choose_backend(settings.backend, settings.points_below, engine.passes, frame);
    if (backend.techniques) engine.passes.splats.make_for(frame, *backend.techniques);
}

Frame Renderer::render(const Scene& scene, const CaptureSettings& settings) {
    Implementation& engine = *implementation_;
    check_settings(settings, engine.device.limits());
    Camera camera = settings.camera;
    if (settings.clip_to_scene) fit_clip_planes(camera, scene.drawn_bounds());

    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.stats.device = device_name();
    const std::size_t texels = std::size_t{settings.width} * settings.height;
    frame.coverage.resize(texels);
    const std::vector<std::byte> raw = engine.render_raw(scene, settings, camera, settings.view, &frame.stats);
    if (settings.want_graph)
        frame.graph = graph::export_graph(engine.graph, engine.executor.plan(), *settings.want_graph);
    const Background& background = scene.background;
    if (is_numeric(settings.view)) {
        const std::vector<float> values = floats_of(raw);
        for (std::size_t i = 0; i < texels; ++i)
            frame.coverage[i] = std::isinf(values[i]) ? 0 : 255;
        const std::uint8_t empty[4] = {encoded(background.colour.r), encoded(background.colour.g),
                                       encoded(background.colour.b),
                                       static_cast<std::uint8_t>(background.transparent ? 0 : 255)};
        frame.rgba = picture_of_numbers(settings.view, values, settings.width, settings.height, empty).rgba;
        if (settings.view == View::kDepth) frame.depth = values;
        if (settings.view == View::kOverlap) count_overlap(frame.stats, values);
    } else {
        frame.rgba.resize(raw.size());
        std::memcpy(frame.rgba.data(), raw.data(), raw.size());
        for (std::size_t i = 0; i < texels; ++i) {
            frame.coverage[i] = frame.rgba[4 * i + 3];
            if (!background.transparent) frame.rgba[4 * i + 3] = 255;
        }
    }
    frame.stats.covered_pixels = static_cast<std::uint64_t>(
        std::count_if(frame.coverage.begin(), frame.coverage.end(), [](std::uint8_t share) { return share >= 128; }));
    if (settings.want_depth && frame.depth.empty())
        frame.depth = floats_of(engine.render_raw(scene, settings, camera, View::kDepth, nullptr));
    if (settings.want_overlap && settings.view != View::kOverlap)
        count_overlap(frame.stats, floats_of(engine.render_raw(scene, settings, camera, View::kOverlap, nullptr)));
    return frame;
}

FrameStats Renderer::render_to(const gpu::Image& destination, const Scene& scene, const CaptureSettings& settings) {
    Implementation& engine = *implementation_;
    if (is_numeric(settings.view)) {
        // What turns numbers into colours runs on the host.
        Frame frame = render(scene, settings);
        gpu::upload(engine.device, destination, std::as_bytes(std::span(frame.rgba)), whole_image(settings),
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        return std::move(frame.stats);
    }
    check_settings(settings, engine.device.limits());
    Camera camera = settings.camera;
    if (settings.clip_to_scene) fit_clip_planes(camera, scene.drawn_bounds());
    FrameStats stats;
    stats.device = device_name();
    const auto copy = [&](graph::Bindings& bindings, graph::ImageHandle picture) {
        const graph::ImageHandle shown = engine.graph.import_image(
            "shown", {.format = destination.options().format, .width = settings.width, .height = settings.height},
            {.after = graph::external::transfer_read()});
        bindings.bind(shown, destination);
        add_copy(engine.graph, picture, shown, settings.width, settings.height);
    };
    engine.draw(scene, settings, camera, settings.view, copy, &stats);
    return stats;
}

graph::FramePicture Renderer::last_graph() const {
    return graph::picture_of(implementation_->graph, &implementation_->executor.plan());
}

std::uint64_t Renderer::attachment_bytes() const {
    return implementation_->executor.statistics().transient_bytes;
}

const std::string& Renderer::device_name() const {
    return implementation_->device.info().name;
}

std::vector<std::string> Renderer::validation_messages() const {
    std::vector<std::string> lines;
    for (const gpu::ValidationMessage& message : implementation_->device.instance().messages())
        lines.push_back(message.id + ": " + message.text);
    return lines;
}

std::vector<std::string> list_devices() {
    const gpu::Instance instance;
    std::vector<std::string> lines;
    for (const gpu::DeviceInfo& info : gpu::list_devices(instance))
        lines.push_back(std::to_string(info.index) + ": " + info.name + (info.is_cpu() ? " [cpu]" : "") +
                        (info.unusable.empty() ? "" : " [unusable: " + info.unusable + "]"));
    return lines;
}

}  // namespace splice
