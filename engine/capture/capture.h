// Rendering without a window, for programs, tests and benchmarks: one Renderer a device, models loaded into it, frames
// out of it as plain arrays.
//
//   Renderer renderer(RendererOptions{});
//   auto model = renderer.load(file.view());
//   CaptureSettings settings;
//   settings.camera = frame_camera(scene.bounds(), {}, settings.width, settings.height);
//   Frame frame = renderer.render(scene_of(model), settings);
#pragma once

#include "engine/passes/splat_plan.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/export/export.h"
#include "engine/render_graph/export/frame_picture.h"
#include "engine/scene/backend.h"
#include "engine/scene/camera.h"
#include "engine/scene/draw_list.h"
#include "engine/scene/kernel.h"
#include "engine/scene/merged_surfels.h"
#include "engine/scene/paging.h"
#include "engine/scene/scene.h"
#include "engine/scene/shading.h"
#include "engine/scene/shown.h"
#include "engine/scene/view.h"
#include "preprocess/model_format/model.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace splice {

namespace gpu {
class Device;
class Image;
}  // namespace gpu

struct RendererOptions {
    std::string device = "auto";  // auto: a real GPU if there is one, else lavapipe; cpu; or an index of list_devices
    bool validate = false;        // validation and synchronisation-validation layers
    std::uint64_t most_splat_groups = 0;  // groups of 64 surfels that compute passes work on at once; 0: all that fit
    graph::ExecutorOptions graph = {};    // switches of the render graph, and what it measures of each pass
};

struct CaptureSettings {
    std::uint32_t width = 512, height = 512;  // pixels
    Camera camera;                            // clip planes are set from the scene's bounds when clip_to_scene
    bool clip_to_scene = true;
    View view = View::kShaded;
    Shown shown = Shown::kHybrid;
    Sides sides = Sides::kAsBaked;
    double epsilon_scale = 1;                         // thesis 4.3.1 uses 0.75..1.5; times each surfel's own epsilon
    Kernel kernel = {};                               // how a splat's weight falls off
    bool prefilter = true;                            // EWA's screen-space low-pass filter (I in V = J Vr J^T + I)
    std::uint32_t antialias = 1;                      // samples along each side of a pixel; of pictures, not of numbers
    Shading shading = Shading::kSurfel;               // where light is computed
    bool want_depth = false;                          // fill Frame::depth
    bool want_overlap = false;                        // fill FrameStats::overlap_mean
    std::optional<graph::ExportFormat> want_graph;    // fill Frame::graph
    bool draw_triangles = true, draw_surfels = true;  // which patches take part
    double merge_px = kMergePixels;  // samples by which merged surfels may differ (engine/scene/merged_surfels.h); 0:
                                     // every surfel is drawn
    double tau = 0;  // pixels that an ellipse may be long that stands for surfels (engine/scene/lod_cut.h); 0: full
                     // detail
    std::optional<double> budget_ms = {};   // tau grows until the costs predict no more (engine/scene/frame_budget.h)
    DrawCosts costs = kSoftwareCosts;       // by which representations are chosen and budgets kept; see calibrate.h
    std::optional<Camera> cut_camera = {};  // with tau or budget: from where levels of detail are chosen; else `camera`
    Backend backend = Backend::kSprite;
    std::optional<double> points_below = {};  // pixels: patches whose splats are all at most this wide are drawn as
                                              // points by every backend but sprites; none: as the backend chooses
    bool wait_for_data = true;  // of paged models, until all that the frame needs is in memory; else nodes
                                // of the point tree stand for what is not
    bool cull_groups = true;    // false: what bounds of several surfels or triangles tell that none can be seen of is
                                // looked at, too; the picture is the same
    bool force_quads = false;   // draw every surfel as an oriented quad, none as a point sprite
    friend bool operator==(const CaptureSettings&, const CaptureSettings&) = default;
};

struct PassTime {
    std::string name;
    double gpu_ms;
    std::optional<gpu::PipelineCounts> counts =
        {};  // with RendererOptions::graph.pipeline_statistics, where there are any
};

/// How the level of detail of a frame was chosen.
struct CutStats {
    double tau = 0;  // pixels; 0: nothing was chosen
    CutStatistics counts;
    std::optional<double> budget_ms = {};  // that tau was chosen for
    double select_ms = 0;                  // of the host: culling and choosing; gathering what was chosen
    double gather_ms = 0;
};

/// What is held of a frame's models on the device, each model once.
struct ResidentBytes {
    std::uint64_t surfels = 0;    // with what the pagers hold and the cut gathered
    std::uint64_t triangles = 0;  // vertices and indices
    std::uint64_t device = 0;     // all that is allocated there, pictures and scratch buffers included
};

struct DrawnBy {
    Backend backend;
    std::uint64_t surfels;  // sent to it, after culling by patch
};

struct FrameStats {
    std::string device;
    Backend backend = Backend::kSprite;  // that drew the frame, or most of its surfels
    std::vector<DrawnBy> drawn_by;       // all that drew some
    Shading shading = Shading::kSurfel;
    std::uint32_t antialias = 1;      // samples along each side of a pixel
    double frame_ms = 0;              // submission to completion of the frame, readback included
    std::vector<PassTime> passes;     // in order of execution
    MergedCounts merged;              // of those
    SetupCounts setup = {};           // where compute passes draw
    std::uint64_t surfels_drawn = 0;  // sent to the device after culling by patch
    std::uint64_t triangles_drawn = 0;
    DrawLoad load = {};
    double predicted_ms = 0;  // of the frame, by CaptureSettings::costs
    DrawCosts costs = {};
    PatchCounts patches = {};
    CutStats cut = {};
    ResidentBytes resident = {};
    PageStats pages = {};
    std::uint64_t covered_pixels = 0;  // at least by half
    double overlap_mean = 0;           // surfels contributing to a pixel, over pixels with any; with want_overlap
    std::uint64_t fragments = 0;       // contributions of surfels to pixels, all together; with want_overlap
};

struct Frame {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;      // sRGB-encoded, rows top to bottom; alpha 255, or coverage where transparent
    std::vector<std::uint8_t> coverage;  // one a pixel: the share of it that surfaces cover, 255 for all of it
    std::vector<float> depth;            // with want_depth: distance along the view axis to the surface itself (epsilon
                                         // taken off), world units; infinite where there is none
    std::string graph;                   // with want_graph: the frame's render graph and its plan
    FrameStats stats;
};

/// Not for use from several threads at once. Frames are a pure function of model, scene and settings: same bytes each
/// time, where they wait for data.
class Renderer {
  public:
    explicit Renderer(const RendererOptions& options);  // throws DeviceError, UsageError (no such device)
    explicit Renderer(gpu::Device& device);             // which must outlive the renderer
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// Uploads; `model` may go away afterwards. The result must not outlive the renderer. With `paging`, surfels beyond
    /// its limit are read as frames need them.
    std::shared_ptr<const GpuModel> load(const ModelView& model, const Paging& paging = {});

    /// Pipelines take long to make. Begins to make, on other threads, those that frames of such settings under these
    /// lights need, if it can be told. Pictures are the same without.
    void make_for(const CaptureSettings& settings, const Lighting& lighting);

    Frame render(const Scene& scene, const CaptureSettings& settings);

    /// The same colours (Frame::rgba, alpha aside) as an image on the device, for windows. `destination` has the
    /// settings' size, format R8G8B8A8_UNORM and usages TRANSFER_DST and TRANSFER_SRC; it is left in
    /// TRANSFER_SRC_OPTIMAL. Counts of pixels and what the settings want beside the picture are not filled in.
    FrameStats render_to(const gpu::Image& destination, const Scene& scene, const CaptureSettings& settings);

    /// The render graph of the last frame, as compiled. There must have been one.
    graph::FramePicture last_graph() const;
    /// Bytes of the last frame's attachments.
    std::uint64_t attachment_bytes() const;

    const std::string& device_name() const;

    /// Messages of the validation layers since the renderer was made; always empty without RendererOptions::validate.
    std::vector<std::string> validation_messages() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// One line a device: "0: llvmpipe (LLVM 15.0.6, 256 bits) [cpu]".
std::vector<std::string> list_devices();

}  // namespace splice
