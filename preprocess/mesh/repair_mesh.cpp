#include "preprocess/mesh/corner_normals.h"
#include "preprocess/mesh/edge_table.h"
#include "preprocess/mesh/flip_caps.h"
#include "preprocess/mesh/orient_triangles.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/triangulate.h"
#include "preprocess/mesh/unit_box.h"
#include "preprocess/mesh/weld_vertices.h"
#include "preprocess/model_format/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

namespace splice {
namespace {

/// Squares and cubes of coordinates must stay finite; nothing that anybody measured comes near.
constexpr double kLargestCoordinate = 1e100;

/// False for not-a-number as well.
bool is_usable(const Vec3d& p) {
    return std::abs(p.x()) <= kLargestCoordinate && std::abs(p.y()) <= kLargestCoordinate &&
           std::abs(p.z()) <= kLargestCoordinate;
}

class Repair {
  public:
    Repair(SourceMesh source, const RepairOptions& options, RepairReport& report, const std::string& name)
        : source_(std::move(source)), options_(options), report_(report), name_(name) {}

    IndexedMesh run() {
        report_ = {};
        report_.source_vertices = source_.positions.size();
        report_.source_polygons = source_.polygon_begin.size() - 1;
        if (source_.corner_position.size() >= kInvalidIndex || source_.positions.size() >= kInvalidIndex) {
            throw InputError(name_, "", "more than 2^32 face corners or vertices");
        }
        judge_vertices();
        place_in_unit_box(triangulate());
        drop_duplicates();
        renumber_positions();
        orient();
        measure_edges();
        fill_corner_attributes();
        fill_normals();
        return std::move(mesh_);
    }

  private:
    /// Corner numbers of the source; triangles_ and mesh_.triangles run in parallel once positions are welded.
    using SourceTriangle = std::array<std::uint32_t, 3>;

    std::uint32_t position_of(const SourceTriangle& t, std::size_t k) const { return source_.corner_position[t[k]]; }

    void judge_vertices() {
        const std::size_t vertices = source_.positions.size();
        std::vector<std::uint8_t> used(vertices, 0);
        for (const std::uint32_t index : source_.corner_position) {
            if (index < vertices) used[index] = 1;
        }
        for (std::size_t v = 0; v < vertices; ++v) {
            if (!is_usable(source_.positions[v])) {
                ++report_.nonfinite_vertices;
            } else if (used[v] == 0) {
                ++report_.isolated_vertices;
            }
        }
    }

    bool is_valid(std::size_t polygon) const {
        const std::uint64_t begin = source_.polygon_begin[polygon], end = source_.polygon_begin[polygon + 1];
        if (end < begin + 3) return false;
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::uint32_t index = source_.corner_position[i];
            if (index >= source_.positions.size() || !is_usable(source_.positions[index])) return false;
        }
        return true;
    }

    /// Returns the box of all valid polygons.
    UnitBox triangulate() {
        const std::size_t polygons = source_.polygon_begin.size() - 1;
        std::vector<std::uint8_t> valid(polygons, 0);
        UnitBox box;
        for (std::size_t p = 0; p < polygons; ++p) {
            const std::uint64_t begin = source_.polygon_begin[p], end = source_.polygon_begin[p + 1];
            if (end >= begin + 3) report_.source_triangles += end - begin - 2;
            valid[p] = is_valid(p) ? 1 : 0;
            if (valid[p] == 0) {
                ++report_.invalid_polygons;
                continue;
            }
            for (std::uint64_t i = begin; i < end; ++i)
                box.include(source_.positions[source_.corner_position[i]]);
        }
        if (!(box.scale() > 0)) throw_nothing_left();
        std::vector<Vec3d> corners;
        std::vector<SourceTriangle> local;
        triangles_.reserve(report_.source_triangles);
        for (std::size_t p = 0; p < polygons; ++p) {
            if (valid[p] == 0) continue;
            const auto begin = static_cast<std::uint32_t>(source_.polygon_begin[p]);
            const auto end = static_cast<std::uint32_t>(source_.polygon_begin[p + 1]);
            local.clear();
            if (end == begin + 3) {
                local.push_back({0, 1, 2});
            } else {
                corners.clear();
                for (std::uint32_t i = begin; i < end; ++i) {
                    corners.push_back(box.to_unit(source_.positions[source_.corner_position[i]]));
                }
                triangulate_polygon(corners, local);
            }
            for (const SourceTriangle& t : local) {
                triangles_.push_back({begin + t[0], begin + t[1], begin + t[2]});
                if (!source_.polygon_material.empty()) materials_.push_back(source_.polygon_material[p]);
            }
        }
        return box;
    }

    void place_in_unit_box(const UnitBox& first_box) {
        UnitBox box = box_of_area(first_box.scale());
        // Dropping a degenerate triangle may shrink the box, which separates points that were equal before: repeat
        // until the box is that of what is left.
        for (;;) {
            if (!(box.scale() > 0)) throw_nothing_left();
            weld(box);
            resolve_degenerate();
            if (triangles_.empty()) throw_nothing_left();
            UnitBox remaining;
            for (const SourceTriangle& t : triangles_)
                include(t, remaining);
            if (remaining == box) break;
            box = remaining;
        }
        mesh_.source_scale = box.scale();
        mesh_.source_offset = box.centre();
    }

    void include(const SourceTriangle& t, UnitBox& box) const {
        for (std::size_t k = 0; k < 3; ++k)
            box.include(source_.positions[position_of(t, k)]);
    }

    /// The box of the triangles that have area as the file gives them; drops the others where they leave it.
    UnitBox box_of_area(double scale) {
        std::vector<SourceTriangle> without_area;
        UnitBox box;
        for (const SourceTriangle& t : triangles_) {
            const Vec3d& a = source_.positions[position_of(t, 0)];
            const Vec3d u = (source_.positions[position_of(t, 1)] - a) / scale;
            const Vec3d v = (source_.positions[position_of(t, 2)] - a) / scale;
            if (u.cross(v).isZero(0)) {
                without_area.push_back(t);
            } else {
                include(t, box);
            }
        }
        if (without_area.empty()) return box;
        std::size_t next = 0;
        report_.degenerate_triangles += keep_triangles([&](std::size_t t) {
            if (next == without_area.size() || triangles_[t] != without_area[next]) return true;
            ++next;
            UnitBox with = box;
            include(triangles_[t], with);
            return with == box;
        });
        return box;
    }

    /// Fills mesh_.positions with the used positions in file order and mesh_.triangles with welded indices.
    void weld(const UnitBox& box) {
        std::vector<std::uint32_t> compact(source_.positions.size(), kInvalidIndex);
        for (const SourceTriangle& t : triangles_) {
            for (std::size_t k = 0; k < 3; ++k)
                compact[position_of(t, k)] = 0;
        }
        mesh_.positions.clear();
        for (std::size_t v = 0; v < compact.size(); ++v) {
            if (compact[v] == kInvalidIndex) continue;
            compact[v] = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.positions.push_back(box.to_unit(source_.positions[v]).cast<float>().cwiseMax(-0.5f).cwiseMin(0.5f));
        }
        const Weld weld = weld_positions(mesh_.positions);
        report_.welded_vertices = weld.merged;
        mesh_.triangles.clear();
        mesh_.triangles.reserve(triangles_.size());
        for (const SourceTriangle& t : triangles_) {
            mesh_.triangles.push_back({weld.representative[compact[position_of(t, 0)]],
                                       weld.representative[compact[position_of(t, 1)]],
                                       weld.representative[compact[position_of(t, 2)]]});
        }
    }

    /// `keep` is asked about each triangle in order.
    template <class Keep>
    std::uint64_t keep_triangles(Keep keep) {
        std::size_t kept = 0;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (!keep(t)) continue;
            triangles_[kept] = triangles_[t];
            if (!mesh_.triangles.empty()) mesh_.triangles[kept] = mesh_.triangles[t];
            if (!materials_.empty()) materials_[kept] = materials_[t];
            ++kept;
        }
        const std::uint64_t dropped = triangles_.size() - kept;
        triangles_.resize(kept);
        if (!mesh_.triangles.empty()) mesh_.triangles.resize(kept);
        if (!materials_.empty()) materials_.resize(kept);
        return dropped;
    }

    void resolve_degenerate() {
        report_.degenerate_triangles += keep_triangles([&](std::size_t t) {
            const Triangle& v = mesh_.triangles[t];
            return v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
        });
        // Each round makes at least one cap less; long rows of caps on one edge, which take a round each, are cut
        // short.
        constexpr int kRounds = 32;
        for (int round = 0; round < kRounds; ++round) {
            const auto flips = find_cap_flips(mesh_.positions, mesh_.triangles);
            if (flips.empty()) break;
            for (const CapFlip& flip : flips)
                flip_cap(flip);
            report_.flipped_caps += flips.size();
        }
        report_.degenerate_triangles +=
            keep_triangles([&](std::size_t t) { return !has_no_area(mesh_.positions, mesh_.triangles[t]); });
    }

    void flip_cap(const CapFlip& flip) {
        const std::size_t cap = flip.cap_corner / 3, beyond = flip.beyond_half_edge / 3;
        const std::size_t m = flip.cap_corner % 3, x = flip.beyond_half_edge % 3, y = (x + 1) % 3;
        const auto apply = [&](auto& triangles) {
            const auto middle = triangles[cap][m];
            triangles[cap] = triangles[beyond];
            triangles[cap][x] = middle;
            triangles[beyond][y] = middle;
        };
        apply(mesh_.triangles);
        apply(triangles_);
        if (!materials_.empty()) materials_[cap] = materials_[beyond];
    }

    void drop_duplicates() {
        // Open addressing on the sorted triple; a slot holds the place of a kept triangle.
        const std::size_t slots = std::bit_ceil(triangles_.size() * 2 + 1);
        std::vector<std::uint32_t> table(slots, kInvalidIndex);
        std::vector<Triangle> seen;
        seen.reserve(triangles_.size());
        report_.duplicate_triangles = keep_triangles([&](std::size_t t) {
            Triangle sorted = mesh_.triangles[t];
            std::sort(sorted.begin(), sorted.end());
            std::uint64_t hash = sorted[0];
            for (const std::uint32_t index : {sorted[1], sorted[2]}) {
                hash = (hash * 0x9e3779b97f4a7c15ull) ^ index;
                hash ^= hash >> 29;
            }
            std::size_t slot = (hash * 0xbf58476d1ce4e5b9ull >> 20) & (slots - 1);
            while (table[slot] != kInvalidIndex) {
                if (seen[table[slot]] == sorted) return false;
                slot = (slot + 1) & (slots - 1);
            }
            table[slot] = static_cast<std::uint32_t>(seen.size());
            seen.push_back(sorted);
            return true;
        });
    }

    void renumber_positions() {
        std::vector<std::uint32_t> renumbered(mesh_.positions.size(), kInvalidIndex);
        for (const Triangle& t : mesh_.triangles) {
            for (const std::uint32_t v : t)
                renumbered[v] = 0;
        }
        std::uint32_t count = 0;
        for (std::size_t v = 0; v < renumbered.size(); ++v) {
            if (renumbered[v] == kInvalidIndex) continue;
            mesh_.positions[count] = mesh_.positions[v];
            renumbered[v] = count++;
        }
        mesh_.positions.resize(count);
        for (Triangle& t : mesh_.triangles) {
            for (std::uint32_t& v : t)
                v = renumbered[v];
        }
    }

    void orient() {
        edges_ = build_edge_table(mesh_.triangles, mesh_.positions.size());
        const auto flipped = find_flipped_triangles(mesh_.positions, mesh_.triangles, edges_);
        for (std::size_t t = 0; t < flipped.size(); ++t) {
            if (flipped[t] == 0) continue;
            turn(t);
            ++report_.flipped_triangles;
        }
        if (report_.flipped_triangles > 0) edges_ = build_edge_table(mesh_.triangles, mesh_.positions.size());
        if (!is_inside_out(mesh_.positions, mesh_.triangles, edges_)) return;
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            turn(t);
        report_.inverted_triangles = triangles_.size();
        edges_ = build_edge_table(mesh_.triangles, mesh_.positions.size());
    }

    void turn(std::size_t triangle) {
        std::swap(mesh_.triangles[triangle][1], mesh_.triangles[triangle][2]);
        std::swap(triangles_[triangle][1], triangles_[triangle][2]);
    }

    void measure_edges() {
        mesh_.consistently_oriented = true;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const auto edge = edges_.edge(e);
            if (edge.size() == 1) {
                ++report_.boundary_edges;
            } else if (edge.size() > 2) {
                ++report_.nonmanifold_edges;
                mesh_.consistently_oriented = false;
            } else if (same_direction(mesh_.triangles, edge[0], edge[1])) {
                mesh_.consistently_oriented = false;
            }
        }
        mesh_.closed = report_.boundary_edges == 0 && report_.nonmanifold_edges == 0;
    }

    void fill_corner_attributes() {
        const std::size_t corners = 3 * triangles_.size();
        if (!source_.corner_uvs.empty()) {
            mesh_.corner_uvs.reserve(corners);
            for (const SourceTriangle& t : triangles_) {
                for (const std::uint32_t c : t) {
                    const Vec2f uv = source_.corner_uvs[c];
                    mesh_.corner_uvs.push_back(uv.allFinite() ? uv : Vec2f(0, 0));
                }
            }
        }
        if (!source_.corner_colours.empty()) {
            mesh_.has_colours = true;
            mesh_.corner_colours.reserve(corners);
            for (const SourceTriangle& t : triangles_) {
                for (const std::uint32_t c : t)
                    mesh_.corner_colours.push_back(source_.corner_colours[c]);
            }
        }
        mesh_.materials = std::move(source_.materials);
        mesh_.images = std::move(source_.images);
        mesh_.triangle_material = std::move(materials_);
        if (mesh_.materials.empty()) mesh_.materials.emplace_back();
        for (std::uint32_t& material : mesh_.triangle_material) {
            if (material >= mesh_.materials.size()) material = 0;
        }
    }

    /// The file's normals, except where there is none or it points into the surface.
    void fill_normals() {
        mesh_.corner_normals =
            compute_corner_normals(mesh_.positions, mesh_.triangles, edges_, options_.crease_angle_degrees);
        report_.computed_normals = mesh_.corner_normals.size();
        if (source_.corner_normals.empty()) return;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3d given = source_.corner_normals[triangles_[t][k]].cast<double>();
                const double length = given.norm();
                Vec3f& normal = mesh_.corner_normals[3 * t + k];
                if (!(length > 0) || !std::isfinite(length)) continue;
                const double agreement = given.dot(normal.cast<double>());
                // The normals of a surface that was inside out may have been so with it.
                const double sign = agreement < 0 && report_.inverted_triangles > 0 ? -1 : 1;
                if (!(sign * agreement > 0)) continue;
                normal = (sign / length * given).cast<float>();
                --report_.computed_normals;
            }
        }
    }

    [[noreturn]] void throw_nothing_left() const {
        throw InputError(name_, "",
                         "no usable triangle among " + std::to_string(report_.source_polygons) + " faces (" +
                             std::to_string(report_.invalid_polygons) + " invalid, the rest without area)");
    }

    SourceMesh source_;
    const RepairOptions& options_;
    RepairReport& report_;
    const std::string& name_;
    std::vector<SourceTriangle> triangles_;
    std::vector<std::uint32_t> materials_;  // one a triangle, or empty
    IndexedMesh mesh_;
    EdgeTable edges_;
};

}  // namespace

IndexedMesh repair_mesh(SourceMesh source, const RepairOptions& options, RepairReport& report,
                        const std::string& name) {
    if (source.polygon_begin.size() <= 1) throw InputError(name, "", "no faces, expected a mesh");
    return Repair(std::move(source), options, report, name).run();
}

}  // namespace splice
