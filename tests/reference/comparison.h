// Puts a frame of the renderer and the oracle's view of the same mesh side by side.
#pragma once

#include "engine/capture/capture.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/indexed_mesh.h"
#include "tests/reference/metrics.h"
#include "tests/reference/reference_scene.h"

#include <filesystem>

namespace splice::reference {

/// Reads and repairs: the mesh that the bake sees. Throws InputError, SystemError.
IndexedMesh load_mesh(const std::filesystem::path& path);

/// Bakes a copy of `mesh` and puts it on the renderer's device.
struct BakedModel {
    Model model;
    BakeStats stats;
    std::shared_ptr<const GpuModel> on_device;
};
BakedModel bake_for(Renderer& renderer, const IndexedMesh& mesh, BakeOptions options,
                    ForcedRepresentation representation = ForcedRepresentation::kHybrid);

/// The engine's camera, as the oracle takes it: the mesh in unit-box units -> source units -> eye.
ReferenceView reference_view(const IndexedMesh& mesh, const Camera& camera, std::uint32_t width, std::uint32_t height);

/// The camera that frames `bounds` as splice-capture does, from `direction` (model to eye, unit).
Camera camera_from(const Box& bounds, const glm::dvec3& direction, std::uint32_t width, std::uint32_t height,
                   bool orthographic = false);

/// What the frame of `scene`, which shows `mesh` alone, should look like.
struct Truth {
    ColourImage image;  // 64 samples a pixel, the scene's lights and background
    Mask coverage;      // of the pixel centres
    Mask inside;        // 4 px inside the coverage
};
Truth truth_of(const ReferenceScene& oracle, const IndexedMesh& mesh, const Scene& scene, const Camera& camera,
               std::uint32_t width, std::uint32_t height, bool two_sided);

/// Agreement of a frame with the truth; dB as psnr() gives them.
struct Agreement {
    double inside_db, frame_db, iou;
};
Agreement compare(const Frame& frame, const Truth& truth);

/// Renders `scene`, which shows `model` alone, baked from `mesh`, and holds the frame's surface against the oracle's.
struct SurfaceCheck {
    SurfaceReport report;
    double iou;
    ColourImage marked;  // see check_surface
};
SurfaceCheck check_frame(Renderer& renderer, const Scene& scene, const ModelView& model, const ReferenceScene& oracle,
                         const IndexedMesh& mesh, CaptureSettings settings);

ColourImage colours(const Frame& frame);

/// For people to look at. Throws SystemError.
void write_png(const std::filesystem::path& path, const ColourImage& image);

}  // namespace splice::reference
