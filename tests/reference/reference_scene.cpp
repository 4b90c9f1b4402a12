#include "tests/reference/reference_scene.h"

#include "tests/reference/srgb.h"

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace splice::reference {
namespace {

glm::vec3 to_glm(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

glm::vec3 linear_colour(std::uint32_t rgba) {
    return {srgb_to_linear(static_cast<std::uint8_t>(rgba)), srgb_to_linear(static_cast<std::uint8_t>(rgba >> 8)),
            srgb_to_linear(static_cast<std::uint8_t>(rgba >> 16))};
}

/// Repeating, bilinear between texel centres, in linear light.
glm::vec3 sample_texture(const Image& image, glm::vec2 uv) {
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const auto wrap = [](std::int64_t i, std::int64_t n) { return ((i % n) + n) % n; };
        const auto wx = static_cast<std::size_t>(wrap(x, image.width));
        const auto wy = static_cast<std::size_t>(wrap(y, image.height));
        const std::uint8_t* p = &image.rgba[4 * (wy * image.width + wx)];
        return glm::vec3(srgb_to_linear(p[0]), srgb_to_linear(p[1]), srgb_to_linear(p[2]));
    };
    const glm::vec2 position = uv * glm::vec2(image.width, image.height) - 0.5f;
    const glm::vec2 corner = glm::floor(position);
    const glm::vec2 f = position - corner;
    const auto x = static_cast<std::int64_t>(corner.x), y = static_cast<std::int64_t>(corner.y);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x), glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x),
                    f.y);
}

/// A uniform number in [0, 1) that depends on its arguments only (PCG's output permutation as a hash).
double hash_to_unit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint32_t state = (a * 0x9e3779b9u) ^ (b * 0x85ebca6bu) ^ (c * 0xc2b2ae35u);
    state = state * 747796405u + 2891336453u;
    const std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return static_cast<double>((word >> 22) ^ word) * 0x1p-32;
}

void for_each_row(std::uint32_t height, const std::function<void(std::uint32_t)>& row) {
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, height, 8), [&](const auto& range) {
        for (std::uint32_t y = range.begin(); y != range.end(); ++y)
            row(y);
    });
}

}  // namespace

Ray pixel_ray(const ReferenceView& view, double x, double y) {
    const glm::dvec4 ndc(2 * x / view.width - 1, 2 * y / view.height - 1, 0.5, 1);
    const glm::dvec4 h = glm::inverse(view.projection) * ndc;
    const glm::dvec3 point = glm::dvec3(h) / h.w;
    if (view.perspective()) return {glm::dvec3(0), glm::normalize(point)};
    return {glm::dvec3(point.x, point.y, 0), glm::dvec3(0, 0, -1)};
}

struct ReferenceScene::Impl {
    const IndexedMesh& mesh;
    RTCDevice device;
    RTCScene scene;

    explicit Impl(const IndexedMesh& m) : mesh(m), device(rtcNewDevice(nullptr)), scene(nullptr) {
        if (!device) throw std::runtime_error("Embree: no device");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles that share an edge
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), m.positions.size()));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), m.triangles.size()));
        if (!vertices || !indices) throw std::runtime_error("Embree: out of memory");
        for (std::size_t i = 0; i < m.positions.size(); ++i)
            std::copy_n(m.positions[i].data(), 3, vertices + 3 * i);
        for (std::size_t t = 0; t < m.triangles.size(); ++t)
            std::copy_n(m.triangles[t].data(), 3, indices + 3 * t);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    /// `ray` in mesh space. The distance along it of the first surface beyond `from`, or kNothing.
    float cast(const Ray& ray, RTCRayHit& hit, float from = 0) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        hit.ray.org_x = static_cast<float>(ray.origin.x);
        hit.ray.org_y = static_cast<float>(ray.origin.y);
        hit.ray.org_z = static_cast<float>(ray.origin.z);
        hit.ray.dir_x = static_cast<float>(ray.direction.x);
        hit.ray.dir_y = static_cast<float>(ray.direction.y);
        hit.ray.dir_z = static_cast<float>(ray.direction.z);
        hit.ray.tnear = from;
        hit.ray.tfar = kNothing;
        hit.ray.time = 0;
        hit.ray.mask = ~0u;
        hit.ray.flags = 0;
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNothing : hit.ray.tfar;
    }

    static Ray in_mesh_space(const Ray& eye, const glm::dmat4& to_mesh) {
        return {glm::dvec3(to_mesh * glm::dvec4(eye.origin, 1)), glm::dvec3(to_mesh * glm::dvec4(eye.direction, 0))};
    }

    /// At a window position: the distance along the view direction, or kNothing. `to_mesh`: from eye to mesh space.
    float depth_through(const ReferenceView& view, const glm::dmat4& to_mesh, double x, double y) const {
        const Ray eye = pixel_ray(view, x, y);
        RTCRayHit record;
        const float t = cast(in_mesh_space(eye, to_mesh), record);
        return t == kNothing ? kNothing : static_cast<float>(t * -eye.direction.z);
    }

    /// What the triangles that are met at one window position show at another if they are moved there: their planes'
    /// depths. Those behind the first count where they come to the front: a wall that folds back behind an outline is
    /// hidden beside it, and beyond it is nearer than what hides it.
    void include_moved(const ReferenceView& view, const glm::dmat4& to_mesh, const glm::dvec2& met_at,
                       const glm::dvec2& shown_at, DepthRange& range) const {
        const Ray beside = in_mesh_space(pixel_ray(view, met_at.x, met_at.y), to_mesh);
        const Ray eye = pixel_ray(view, shown_at.x, shown_at.y), ray = in_mesh_space(eye, to_mesh);
        RTCRayHit record;
        float t = cast(beside, record);
        if (t == kNothing) return range.include(kNothing);
        const auto shown = [&] {
            const glm::dvec3 normal(record.hit.Ng_x, record.hit.Ng_y, record.hit.Ng_z);
            const glm::dvec3 met = beside.origin + double{t} * beside.direction;
            const double distance = glm::dot(met - ray.origin, normal) / glm::dot(ray.direction, normal);
            return static_cast<float>((std::isfinite(distance) ? distance : double{t}) * -eye.direction.z);
        };
        const float front = shown();
        range.include(front);
        for (;;) {
            const float next = cast(beside, record, std::nextafter(t, kNothing));
            if (next == kNothing || next <= t) return;
            t = next;
            // Beyond what hides it, and not past the eye.
            if (const float depth = shown(); depth > 0 && depth < front) range.include(depth);
        }
    }

    SurfacePoint point(const RTCHit& hit, const glm::vec3& position, const glm::vec3& to_eye) const {
        const std::size_t t = hit.primID;
        const glm::vec3 weight(1 - hit.u - hit.v, hit.u, hit.v);
        const auto blend = [&](const auto& values, auto convert) {
            auto sum = convert(values[3 * t]) * weight[0];
            for (int k = 1; k < 3; ++k)
                sum += convert(values[3 * t + static_cast<std::size_t>(k)]) * weight[k];
            return sum;
        };
        SurfacePoint p;
        p.position = position;
        p.to_eye = to_eye;
        const glm::vec3 normal = blend(mesh.corner_normals, to_glm);
        // Opposite corner normals may cancel; the face's normal stands in.
        p.normal = glm::length(normal) > 1e-6f ? glm::normalize(normal)
                                               : glm::normalize(glm::vec3(hit.Ng_x, hit.Ng_y, hit.Ng_z));
        const MeshMaterial& material = mesh.materials[mesh.triangle_material.empty() ? 0 : mesh.triangle_material[t]];
        p.colour = linear_colour(material.diffuse);
        if (!mesh.corner_colours.empty()) p.colour *= blend(mesh.corner_colours, linear_colour);
        if (material.image != kNoImage && !mesh.corner_uvs.empty())
            p.colour *= sample_texture(mesh.images[material.image],
                                       blend(mesh.corner_uvs, [](const Vec2f& v) { return glm::vec2(v.x(), v.y()); }));
        return p;
    }
};

ReferenceScene::ReferenceScene(const IndexedMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
ReferenceScene::~ReferenceScene() = default;

bool ReferenceScene::hit(const Ray& ray, const glm::vec3& to_eye, SurfacePoint& point, double& distance) const {
    RTCRayHit record;
    const float t = impl_->cast(ray, record);
    if (t == kNothing) return false;
    distance = t;
    point = impl_->point(record.hit, glm::vec3(ray.origin + distance * ray.direction), to_eye);
    return true;
}

DepthImage ReferenceScene::depth(const ReferenceView& view) const {
    DepthImage image(view.width, view.height, kNothing);
    const glm::dmat4 to_mesh = glm::inverse(view.view);
    for_each_row(view.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < view.width; ++x) {
            image.at(x, y) = impl_->depth_through(view, to_mesh, x + 0.5, y + 0.5);
        }
    });
    return image;
}

DepthRange ReferenceScene::range_in_pixel(const ReferenceView& view, std::uint32_t x, std::uint32_t y,
                                          std::uint32_t samples_per_side) const {
    const glm::dmat4 to_mesh = glm::inverse(view.view);
    DepthRange range;
    for (std::uint32_t j = 0; j < samples_per_side; ++j)
        for (std::uint32_t i = 0; i < samples_per_side; ++i)
            range.include(impl_->depth_through(view, to_mesh, x + (i + 0.5) / samples_per_side,
                                               y + (j + 0.5) / samples_per_side));
    constexpr double kSnap = 1.0 / 512;  // pixels: how far rasterisers move corners
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    for (const double dy : {-kSnap, 0.0, kSnap})
        for (const double dx : {-kSnap, 0.0, kSnap}) {
            const glm::dvec2 aside(dx, dy);
            impl_->include_moved(view, to_mesh, centre + aside, centre, range);
            impl_->include_moved(view, to_mesh, centre + aside, centre - aside, range);
        }
    return range;
}

ColourImage ReferenceScene::shaded(const ReferenceView& view, const Shader& shader, const glm::vec3& background,
                                   std::uint32_t samples_per_side) const {
    ColourImage image(view.width, view.height);
    const glm::dmat4 to_mesh = glm::inverse(view.view);
    const auto stratum = 1.0 / samples_per_side;
    const auto jitter = [&](std::uint32_t x, std::uint32_t y, std::uint32_t dimension) {
        return samples_per_side == 1 ? 0.5 : hash_to_unit(x, y, dimension);
    };
    for_each_row(view.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < view.width; ++x) {
            glm::dvec3 sum(0);
            for (std::uint32_t s = 0; s < samples_per_side * samples_per_side; ++s) {
                const double dx = (s % samples_per_side + jitter(x, y, 2 * s)) * stratum;
                const double dy = (s / samples_per_side + jitter(x, y, 2 * s + 1)) * stratum;
                const Ray eye = pixel_ray(view, x + dx, y + dy);
                const Ray ray = Impl::in_mesh_space(eye, to_mesh);
                SurfacePoint point;
                double distance = 0;
                sum +=
                    hit(ray, -glm::vec3(glm::normalize(ray.direction)), point, distance) ? shader(point) : background;
            }
            const glm::dvec3 mean = sum * (stratum * stratum);
            image.at(x, y) = {linear_to_srgb8(mean.r), linear_to_srgb8(mean.g), linear_to_srgb8(mean.b)};
        }
    });
    return image;
}

std::vector<glm::dvec3> view_directions() {
    std::vector<glm::dvec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x || y || z) directions.push_back(glm::normalize(glm::dvec3(x, y, z)));
    return directions;
}

}  // namespace splice::reference
