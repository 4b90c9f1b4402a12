#include "preprocess/mesh/shape_builder.h"
#include "preprocess/mesh/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace splice::shapes {

SourceMesh cube(std::uint32_t cells) {
    cells = std::max(cells, 1u);
    SourceMesh mesh = empty_mesh();
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> index_of;  // lattice point -> vertex
    const auto vertex = [&](const std::array<std::uint32_t, 3>& lattice) {
        const auto [entry, is_new] = index_of.try_emplace(lattice, 0u);
        if (is_new) {
            const Vec3d steps(lattice[0], lattice[1], lattice[2]);
            entry->second = add_vertex(mesh, steps / cells - Vec3d::Constant(0.5));
        }
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            // (u, v, axis) is right-handed, so u before v faces the positive side.
            const std::size_t u = (axis + (high ? 1 : 2)) % 3, v = (axis + (high ? 2 : 1)) % 3;
            for (std::uint32_t i = 0; i < cells; ++i) {
                for (std::uint32_t j = 0; j < cells; ++j) {
                    const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
                        std::array<std::uint32_t, 3> lattice{};
                        lattice[axis] = high ? cells : 0;
                        lattice[u] = i + di;
                        lattice[v] = j + dj;
                        return vertex(lattice);
                    };
                    add_polygon(mesh, {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
                }
            }
        }
    }
    return mesh;
}

SourceMesh uv_sphere(std::uint32_t slices, std::uint32_t stacks) {
    slices = std::max(slices, 3u);
    stacks = std::max(stacks, 2u);
    SourceMesh mesh = empty_mesh();
    const std::uint32_t south = add_vertex(mesh, -Vec3d::UnitZ());
    for (std::uint32_t ring = 1; ring < stacks; ++ring) {
        const double polar = std::numbers::pi * (static_cast<double>(ring) / stacks - 0.5);
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            const double azimuth = 2 * std::numbers::pi * slice / slices;
            add_vertex(
                mesh, Vec3d(std::cos(polar) * std::cos(azimuth), std::cos(polar) * std::sin(azimuth), std::sin(polar)));
        }
    }
    const std::uint32_t north = add_vertex(mesh, Vec3d::UnitZ());
    const auto at = [&](std::uint32_t ring, std::uint32_t slice) { return 1 + (ring - 1) * slices + slice % slices; };
    const auto uv = [&](double slice, std::uint32_t ring) {
        mesh.corner_uvs.emplace_back(static_cast<float>(slice / slices),
                                     static_cast<float>(1 - static_cast<double>(ring) / stacks));
    };
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
        add_polygon(mesh, {south, at(1, slice + 1), at(1, slice)});
        uv(slice + 0.5, 0);
        uv(slice + 1, 1);
        uv(slice, 1);
        for (std::uint32_t ring = 1; ring + 1 < stacks; ++ring) {
            add_polygon(mesh, {at(ring, slice), at(ring, slice + 1), at(ring + 1, slice + 1), at(ring + 1, slice)});
            uv(slice, ring);
            uv(slice + 1, ring);
            uv(slice + 1, ring + 1);
            uv(slice, ring + 1);
        }
        add_polygon(mesh, {at(stacks - 1, slice), at(stacks - 1, slice + 1), north});
        uv(slice, stacks - 1);
        uv(slice + 1, stacks - 1);
        uv(slice + 0.5, stacks);
    }
    return mesh;
}

namespace {

constexpr double kGolden = std::numbers::phi;
const std::array<Vec3d, 12> kIcosahedron = {Vec3d(-1, kGolden, 0),  Vec3d(1, kGolden, 0),   Vec3d(-1, -kGolden, 0),
                                            Vec3d(1, -kGolden, 0),  Vec3d(0, -1, kGolden),  Vec3d(0, 1, kGolden),
                                            Vec3d(0, -1, -kGolden), Vec3d(0, 1, -kGolden),  Vec3d(kGolden, 0, -1),
                                            Vec3d(kGolden, 0, 1),   Vec3d(-kGolden, 0, -1), Vec3d(-kGolden, 0, 1)};
constexpr std::array<std::array<std::uint32_t, 3>, 20> kIcosahedronFaces = {{
    {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1},
}};

/// The lattice of one face of the icosahedron, with the vertices on its edges and corners shared by all faces.
class IcosahedronLattice {
  public:
    IcosahedronLattice(std::uint32_t frequency, SourceMesh& mesh) : frequency_(frequency), mesh_(mesh) {
        for (const Vec3d& corner : kIcosahedron)
            add_vertex(mesh, corner.normalized());
    }

    void face(const std::array<std::uint32_t, 3>& f) {
        const std::uint32_t n = frequency_;
        const auto edge_ab = edge(f[0], f[1]), edge_ac = edge(f[0], f[2]), edge_bc = edge(f[1], f[2]);
        std::vector<std::vector<std::uint32_t>> rows(n + 1);  // row i runs from edge ab to edge ac and has i + 1 points
        for (std::uint32_t i = 0; i <= n; ++i) {
            for (std::uint32_t j = 0; j <= i; ++j) {
                if (i == n) {
                    rows[i].push_back(edge_bc[j]);
                } else if (j == 0) {
                    rows[i].push_back(edge_ab[i]);
                } else if (j == i) {
                    rows[i].push_back(edge_ac[i]);
                } else {
                    const Vec3d p =
                        kIcosahedron[f[0]] * (n - i) + kIcosahedron[f[1]] * (i - j) + kIcosahedron[f[2]] * j;
                    rows[i].push_back(add_vertex(mesh_, p.normalized()));
                }
            }
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = 0; j <= i; ++j) {
                add_polygon(mesh_, {rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]});
                if (j < i) add_polygon(mesh_, {rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]});
            }
        }
    }

  private:
    /// The frequency + 1 vertices from corner a to corner b.
    std::vector<std::uint32_t> edge(std::uint32_t a, std::uint32_t b) {
        auto& points = edges_[std::minmax(a, b)];
        const auto [low, high] = std::minmax(a, b);
        if (points.empty()) {
            points.push_back(low);
            for (std::uint32_t i = 1; i < frequency_; ++i) {
                points.push_back(
                    add_vertex(mesh_, (kIcosahedron[low] * (frequency_ - i) + kIcosahedron[high] * i).normalized()));
            }
            points.push_back(high);
        }
        return a < b ? points : std::vector<std::uint32_t>(points.rbegin(), points.rend());
    }

    std::uint32_t frequency_;
    SourceMesh& mesh_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges_;
};

}  // namespace

SourceMesh ico_sphere(std::uint32_t frequency) {
    SourceMesh mesh = empty_mesh();
    IcosahedronLattice lattice(std::max(frequency, 1u), mesh);
    for (const auto& face : kIcosahedronFaces)
        lattice.face(face);
    return mesh;
}

}  // namespace splice::shapes
