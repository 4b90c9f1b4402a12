#include "tests/reference/comparison.h"

#include "engine/capture/png_file.h"
#include "preprocess/mesh/read_mesh.h"
#include "tests/reference/lighting_twin.h"
#include "tests/reference/surfel_tolerance.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace splice::reference {

namespace {

/// Linear light of the scene's background.
glm::vec3 background_light(const Background& background) {
    const auto decode = [](double c) {
        return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    };
    return {decode(background.colour.r), decode(background.colour.g), decode(background.colour.b)};
}

Mask coverage_of(const Frame& frame) {
    Mask mask(frame.width, frame.height);
    std::transform(frame.coverage.begin(), frame.coverage.end(), mask.pixels.begin(),
                   [](std::uint8_t c) { return static_cast<std::uint8_t>(c >= 128); });
    return mask;
}

/// Distances along the view direction in world units; kNothing where the frame covers nothing.
DepthImage depths(const Frame& frame) {
    DepthImage image(frame.width, frame.height, kNothing);
    if (frame.depth.size() != image.pixels.size()) throw std::invalid_argument("the frame was rendered without depth");
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (frame.coverage[i]) image.pixels[i] = frame.depth[i];
    return image;
}

}  // namespace

IndexedMesh load_mesh(const std::filesystem::path& path) {
    RepairReport report;
    return repair_mesh(read_mesh_file(path), RepairOptions{}, report, path.string());
}

BakedModel bake_for(Renderer& renderer, const IndexedMesh& mesh, BakeOptions options,
                    ForcedRepresentation representation) {
    options.cluster.representation = representation;
    BakedModel baked;
    baked.model = build_model(mesh, options, baked.stats);
    baked.on_device = renderer.load(view_of(baked.model));
    return baked;
}

ReferenceView reference_view(const IndexedMesh& mesh, const Camera& camera, std::uint32_t width, std::uint32_t height) {
    const Vec3d& offset = mesh.source_offset;
    const glm::dmat4 to_source = glm::scale(
        glm::translate(glm::dmat4(1), glm::dvec3(offset.x(), offset.y(), offset.z())), glm::dvec3(mesh.source_scale));
    return {view_matrix(camera) * to_source, projection_matrix(camera, width, height), width, height};
}

Camera camera_from(const Box& bounds, const glm::dvec3& direction, std::uint32_t width, std::uint32_t height,
                   bool orthographic) {
    Framing framing;
    framing.azimuth_degrees = glm::degrees(std::atan2(direction.x, direction.z));
    framing.elevation_degrees = glm::degrees(std::asin(std::clamp(direction.y, -1.0, 1.0)));
    framing.orthographic = orthographic;
    return frame_camera(bounds, framing, width, height);
}

ColourImage colours(const Frame& frame) {
    ColourImage image(frame.width, frame.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {frame.rgba[4 * i], frame.rgba[4 * i + 1], frame.rgba[4 * i + 2]};
    return image;
}

void write_png(const std::filesystem::path& path, const ColourImage& image) {
    Picture picture{image.width, image.height, {}};
    for (const Rgb8 pixel : image.pixels)
        picture.rgba.insert(picture.rgba.end(), {pixel.r, pixel.g, pixel.b, 255});
    splice::write_png(path, picture);
}

Truth truth_of(const ReferenceScene& oracle, const IndexedMesh& mesh, const Scene& scene, const Camera& camera,
               std::uint32_t width, std::uint32_t height, bool two_sided) {
    const ReferenceView view = reference_view(mesh, camera, width, height);
    Truth truth;
    truth.image =
        oracle.shaded(view, lighting_twin(scene.lighting, mesh, camera, two_sided), background_light(scene.background));
    truth.coverage = covered(oracle.depth(view));
    truth.inside = eroded(truth.coverage, 4);
    return truth;
}

Agreement compare(const Frame& frame, const Truth& truth) {
    const ColourImage image = colours(frame);
    return {psnr(image, truth.image, &truth.inside), psnr(image, truth.image),
            silhouette_iou(coverage_of(frame), truth.coverage)};
}

SurfaceCheck check_frame(Renderer& renderer, const Scene& scene, const ModelView& model, const ReferenceScene& oracle,
                         const IndexedMesh& mesh, CaptureSettings settings) {
    settings.want_depth = true;
    const DepthImage shown = depths(renderer.render(scene, settings));
    const ReferenceView view = reference_view(mesh, settings.camera, settings.width, settings.height);
    const DepthImage truth = oracle.depth(view);
    const Tolerance tolerance = surfel_tolerance(model, view, truth, static_cast<float>(settings.epsilon_scale));
    SurfaceCheck check;
    check.report = check_surface(shown, truth, tolerance, &check.marked,
                                 [&](std::uint32_t x, std::uint32_t y) { return oracle.range_in_pixel(view, x, y); });
    check.iou = silhouette_iou(covered(shown), covered(truth));
    return check;
}

}  // namespace splice::reference
