#include "preprocess/mesh/shape_builder.h"
#include "preprocess/mesh/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace splice::shapes {

double bumpy_radius(const Vec3d& d) {
    return 1 + 0.06 * std::sin(7 * d.x()) * std::sin(7 * d.y() + 1) * std::sin(7 * d.z() + 2) +
           0.01 * std::sin(31 * d.x() + 17 * d.y()) * std::sin(29 * d.z());
}

Vec3d bumpy_normal(const Vec3d& d) {
    const double sx = std::sin(7 * d.x()), cx = std::cos(7 * d.x());
    const double sy = std::sin(7 * d.y() + 1), cy = std::cos(7 * d.y() + 1);
    const double sz = std::sin(7 * d.z() + 2), cz = std::cos(7 * d.z() + 2);
    const double fine = 31 * d.x() + 17 * d.y();
    const double across = 0.01 * std::cos(fine) * std::sin(29 * d.z());
    const Vec3d gradient(0.42 * cx * sy * sz + 31 * across, 0.42 * sx * cy * sz + 17 * across,
                         0.42 * sx * sy * cz + 0.29 * std::sin(fine) * std::cos(29 * d.z()));
    // The surface is r(d) d over the unit sphere, so only the tangential part of the gradient tilts it.
    return (bumpy_radius(d) * d - (gradient - gradient.dot(d) * d)).normalized();
}

SourceMesh bumpy_sphere(std::uint64_t triangles) {
    const auto frequency = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(triangles) / 20)));
    SourceMesh mesh = ico_sphere(frequency);
    VertexAttributes attributes;
    for (Vec3d& position : mesh.positions) {
        attributes.normals.push_back(bumpy_normal(position).cast<float>());
        position *= bumpy_radius(position);
    }
    constexpr double kQuarterInSrgb = 0.537099;  // encodes linear 0.25
    attributes.colours.assign(mesh.positions.size(), pack_colour(0, kQuarterInSrgb, 1));
    expand_vertex_attributes(attributes, mesh);
    return mesh;
}

namespace {

Vec3d knot_point(double p, double q, double t) {
    const double radius = 2 + std::cos(q * t);
    return {radius * std::cos(p * t), radius * std::sin(p * t), -std::sin(q * t)};
}

/// A colour wheel of constant lightness, in sRGB.
std::uint32_t hue(double turns) {
    const auto channel = [&](double shift) { return 0.55 + 0.4 * std::cos(2 * std::numbers::pi * (turns - shift)); };
    return pack_colour(channel(0), channel(1.0 / 3), channel(2.0 / 3));
}

}  // namespace

SourceMesh torus_knot(std::uint32_t p, std::uint32_t q, std::uint32_t segments, std::uint32_t sides) {
    p = std::max(p, 1u);
    q = std::max(q, 1u);
    segments = std::max(segments, 3 * p * q);
    sides = std::max(sides, 3u);
    constexpr double kTubeRadius = 0.4;
    SourceMesh mesh = empty_mesh();
    VertexAttributes attributes;
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double t = 2 * std::numbers::pi * i / segments;
        const double h = 1e-4;
        const Vec3d centre = knot_point(p, q, t);
        const Vec3d tangent = (knot_point(p, q, t + h) - knot_point(p, q, t - h)).normalized();
        // The torus's own normal is a frame that closes up by itself, which a transported one does not.
        const Vec3d spine(2 * std::cos(p * t), 2 * std::sin(p * t), 0);
        const Vec3d out = (centre - spine - tangent * tangent.dot(centre - spine)).normalized();
        const Vec3d side = tangent.cross(out);
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            const Vec3d normal = std::cos(angle) * out + std::sin(angle) * side;
            add_vertex(mesh, centre + kTubeRadius * normal);
            attributes.colours.push_back(hue(3.0 * i / segments));
        }
    }
    for (std::uint32_t i = 0; i < segments; ++i) {
        const std::uint32_t here = i * sides, there = (i + 1) % segments * sides;
        for (std::uint32_t k = 0; k < sides; ++k) {
            const std::uint32_t next = (k + 1) % sides;
            add_polygon(mesh, {here + k, here + next, there + next, there + k});
        }
    }
    expand_vertex_attributes(attributes, mesh);
    return mesh;
}

namespace {

/// Gradient noise (Perlin 2002, "Improving noise", with hashed gradients) in the plane, about -0.7..0.7.
class GradientNoise {
  public:
    explicit GradientNoise(std::uint32_t seed) : seed_(seed) {}

    double at(double x, double y) const {
        const double x0 = std::floor(x), y0 = std::floor(y);
        const double fx = x - x0, fy = y - y0;
        const auto corner = [&](int dx, int dy) {
            const double angle = gradient_angle(static_cast<std::int32_t>(x0) + dx, static_cast<std::int32_t>(y0) + dy);
            return std::cos(angle) * (fx - dx) + std::sin(angle) * (fy - dy);
        };
        const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
        return std::lerp(std::lerp(corner(0, 0), corner(1, 0), fade(fx)),
                         std::lerp(corner(0, 1), corner(1, 1), fade(fx)), fade(fy));
    }

  private:
    double gradient_angle(std::int32_t x, std::int32_t y) const {
        std::uint32_t h =
            seed_ ^ (static_cast<std::uint32_t>(x) * 0x9e3779b1u) ^ (static_cast<std::uint32_t>(y) * 0x85ebca77u);
        h = (h ^ (h >> 15)) * 0x2c1b3c6du;
        h = (h ^ (h >> 12)) * 0x297a2d39u;
        h ^= h >> 15;
        return 2 * std::numbers::pi * h / 4294967296.0;
    }
    std::uint32_t seed_;
};

double terrain_height(const GradientNoise& noise, double x, double y) {
    double height = 0, amplitude = 0.12, frequency = 3;
    for (int octave = 0; octave < 7; ++octave) {
        height += amplitude * noise.at(frequency * x, frequency * y);
        amplitude *= 0.48;
        frequency *= 2.03;
    }
    return height;
}

std::uint32_t terrain_colour(double height, double steepness) {
    const Vec3d grass(0.33, 0.45, 0.22), rock(0.47, 0.42, 0.37), snow(0.94, 0.95, 0.97);
    const double is_rock = std::clamp((steepness - 0.5) / 0.4, 0.0, 1.0);
    const double is_snow = std::clamp((height - 0.04) / 0.03, 0.0, 1.0) * (1 - is_rock);
    const Vec3d colour = (1 - is_snow) * ((1 - is_rock) * grass + is_rock * rock) + is_snow * snow;
    return pack_colour(colour[0], colour[1], colour[2]);
}

}  // namespace

SourceMesh terrain(std::uint32_t cells, std::uint32_t seed) {
    cells = std::max(cells, 1u);
    const GradientNoise noise(seed);
    SourceMesh mesh = empty_mesh();
    VertexAttributes attributes;
    const double step = 1.0 / cells;
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const double x = i * step, y = j * step, height = terrain_height(noise, x, y);
            add_vertex(mesh, {x - 0.5, y - 0.5, height});
            constexpr double kAhead = 1.0 / 512;
            const double steepness = std::hypot(terrain_height(noise, x + kAhead, y) - height,
                                                terrain_height(noise, x, y + kAhead) - height) /
                                     kAhead;
            attributes.colours.push_back(terrain_colour(height, steepness));
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
            add_polygon(mesh, {a, b, d});
            add_polygon(mesh, {a, d, c});
        }
    }
    expand_vertex_attributes(attributes, mesh);
    return mesh;
}

}  // namespace splice::shapes
