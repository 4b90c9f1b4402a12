// Points on surfaces that are known exactly.
#pragma once

#include "preprocess/cloud/unit_cloud.h"

#include <Eigen/Geometry>
#include <random>

namespace splice::test {

inline std::vector<Vec3f> sphere_points(std::size_t count, unsigned seed, float radius = 0.5f) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<Vec3f> points(count);
    for (Vec3f& point : points)
        point = radius * Vec3f(normal(random), normal(random), normal(random)).normalized();
    return points;
}

/// Uniform over the area of a torus about z; `normals`, if wanted, get the outward normals.
inline std::vector<Vec3f> torus_points(std::size_t count, unsigned seed, std::vector<Vec3f>* normals = nullptr) {
    constexpr float kRing = 0.35f, kTube = 0.15f;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> angle(0, 6.2831853f), share(0, 1);
    std::vector<Vec3f> points;
    while (points.size() < count) {
        const float u = angle(random), v = angle(random);
        if (share(random) * (kRing + kTube) > kRing + kTube * std::cos(v)) continue;
        const Vec3f out(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
        points.push_back(Vec3f(kRing * std::cos(u), kRing * std::sin(u), 0) + kTube * out);
        if (normals != nullptr) normals->push_back(out);
    }
    return points;
}

inline UnitCloud unit_cloud(std::vector<Vec3f> points) {
    PointCloud cloud;
    cloud.source_points = points.size();
    cloud.offsets = std::move(points);
    return make_unit_cloud(std::move(cloud));
}

}  // namespace splice::test
