// The frame of the hybrid pipeline (thesis 3.4, 4.3): triangles and surfels spliced in one depth buffer.
#pragma once

#include "engine/passes/box_pass.h"
#include "engine/passes/frame_data.h"
#include "engine/passes/resolve_pass.h"
#include "engine/passes/splat_passes.h"
#include "engine/passes/surfel_attribute_pass.h"
#include "engine/passes/surfel_normalise_pass.h"
#include "engine/passes/surfel_visibility_pass.h"
#include "engine/passes/triangle_pass.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/scene/backend.h"
#include "engine/scene/draw_list.h"
#include "engine/vulkan/device.h"

#include <optional>
#include <vector>

namespace splice {

/// Formats that the device was found to support.
struct FrameFormats {
    VkFormat depth_stencil;
    VkFormat accumulation;  // blendable float, 32 bits a channel where possible
    explicit FrameFormats(const gpu::Device& device);
};

/// Shaders, layouts and pipelines of all passes of one device; made once.
struct FramePasses {
    /// `most_splat_groups`: see SplatPasses.
    explicit FramePasses(gpu::Device& device, std::uint64_t most_splat_groups = 0);

    FrameData data;
    FrameFormats formats;
    TrianglePass triangle;
    SurfelVisibilityPass surfel_visibility;
    SurfelAttributePass surfel_attribute;
    SplatPasses splats;
    SurfelNormalisePass surfel_normalise;
    BoxPass boxes;
    ResolvePass resolve;
};

/// What draws a frame's surfels.
struct SurfelBackend {
    std::optional<Techniques> techniques = {};  // none: sprites, all of them
    double small_px = 0;                        // see DrawListOptions
};

/// What was asked for where it can draw the frame, else sprites. `points_below`: pixels; surfels of patches whose
/// splats are all at most this wide become points; none: the default.
SurfelBackend choose_backend(Backend wanted, std::optional<double> points_below, const FramePasses& passes,
                             const FrameSettings& settings);

/// How many surfels each backend draws, those that draw any.
struct BackendShare {
    Backend backend;
    std::uint64_t surfels;
};
std::vector<BackendShare> backend_shares(const SurfelBackend& backend, const DrawList& draws);

/// Format of the picture: 8-bit RGBA, sRGB-encoded by the shader, alpha coverage; or float for numeric views, where
/// uncovered pixels keep +infinity.
VkFormat picture_format(View view);

/// Adds the passes of one frame to the graph, in order, and returns the picture. `draws`, `settings` and `passes` must
/// live until the graph has been executed; passes.data must have been updated with the same settings. Binds what the
/// passes keep from frame to frame.
graph::ImageHandle add_frame(graph::Graph& graph, graph::Bindings& bindings, FramePasses& passes,
                             const SurfelBackend& backend, const FrameSettings& settings, const Background& background,
                             const DrawList& draws);

}  // namespace splice
