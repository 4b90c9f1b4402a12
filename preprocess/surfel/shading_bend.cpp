#include "preprocess/surfel/shading_bend.h"

#include "preprocess/model_format/model_format.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/surface_point.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace splice {
namespace {

std::vector<Vec3f> cell_normals(const IndexedMesh& mesh, const CoverCells& cells) {
    std::vector<Vec3f> normals(cells.size());
    for (const CellChunk& chunk : cells.chunks) {
        for (std::uint32_t i = chunk.first; i < chunk.first + chunk.count; ++i)
            normals[i] =
                surfel_normal(mesh, chunk.triangle, barycentric(mesh, chunk.triangle, cells.centre(i)), chunk.normal);
    }
    return normals;
}

}  // namespace

std::vector<ShadingBend> fit_shading_bends(const IndexedMesh& mesh, const CoverCells& cells,
                                           const std::vector<CoverSite>& sites) {
    const std::vector<Vec3f> normals = cell_normals(mesh, cells);
    std::vector<ShadingBend> bends(sites.size(), ShadingBend{0, 0, 0, 0, 0});
    for (std::size_t site = 0; site < sites.size(); ++site) {
        const Vec3f p = sites[site].position, exact = sites[site].normal;
        const auto stored = decode_octahedral(encode_octahedral(exact.x(), exact.y(), exact.z()));
        const TangentFrame frame = tangents_of(stored);
        const Vec3f n(stored[0], stored[1], stored[2]), s(frame.s[0], frame.s[1], frame.s[2]),
            t(frame.t[0], frame.t[1], frame.t[2]);
        const float radius = sites[site].radius, limit = radius * radius;
        // Both tangential components against (1, u, v), u and v in radii.
        Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
        Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
        cells.for_each_range_near(p, radius, n, [&](std::uint32_t first, std::uint32_t end) {
            for (std::uint32_t i = first; i < end; ++i) {
                const Vec3f d = cells.centre(i) - p;
                const float cosine = normals[i].dot(n);
                if (d.squaredNorm() > limit || cosine < kLeastAgreement) continue;
                const Eigen::Vector3d basis(1.0, static_cast<double>(d.dot(s) / radius),
                                            static_cast<double>(d.dot(t) / radius));
                const Eigen::RowVector2d lean(static_cast<double>(normals[i].dot(s) / cosine),
                                              static_cast<double>(normals[i].dot(t) / cosine));
                const double weight = static_cast<double>(cells.area[i]);
                normal_matrix += weight * basis * basis.transpose();
                right += weight * basis * lean;
            }
        });
        if (!(normal_matrix(0, 0) > 0)) continue;
        // Cells along a line leave one direction open: a little stiffness holds it at no change.
        normal_matrix(1, 1) += 0.01 * normal_matrix(0, 0);
        normal_matrix(2, 2) += 0.01 * normal_matrix(0, 0);
        const Eigen::Matrix<double, 3, 2> fit = normal_matrix.ldlt().solve(right);
        const double r = static_cast<double>(radius);
        bends[site] = {static_cast<float>(fit(0, 0)), static_cast<float>(fit(0, 1)), static_cast<float>(fit(1, 0) / r),
                       static_cast<float>(0.5 * (fit(1, 1) + fit(2, 0)) / r), static_cast<float>(fit(2, 1) / r)};
    }
    return bends;
}

std::array<std::int8_t, 5> encode_shading_bend(const ShadingBend& bend, float radius) {
    std::array<std::int8_t, 5> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const float share = std::clamp(bend[i] * (i < 2 ? 1 : radius) / format::kLargestBend[i], -1.0f, 1.0f);
        bytes[i] = static_cast<std::int8_t>(std::lround(share * 127));
    }
    return bytes;
}

}  // namespace splice
