// File -> repaired IndexedMesh, in two steps so that each can be tested: read_mesh_file parses (one file a format
// behind it), repair_mesh makes the result fit IndexedMesh's invariants and counts what it did.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/mesh/source_file.h"
#include "preprocess/progress.h"

#include <filesystem>
#include <optional>

namespace splice {

/// What a file says, before any judgement: polygons of any size, attributes where the file has them. Corner i of the
/// flat corner list belongs to the polygon p with polygon_begin[p] <= i < polygon_begin[p + 1].
struct SourceMesh {
    std::vector<Vec3d> positions;
    std::vector<std::uint64_t> polygon_begin;     // size = polygons + 1; {0} when there are none
    std::vector<std::uint32_t> corner_position;   // may be out of range: repair drops such polygons and counts them
    std::vector<Vec3f> corner_normals;            // empty or one a corner; zero vector = missing
    std::vector<Vec2f> corner_uvs;                // empty or one a corner; v grows downwards
    std::vector<std::uint32_t> corner_colours;    // empty or one a corner
    std::vector<std::uint32_t> polygon_material;  // empty or one a polygon
    std::vector<MeshMaterial> materials;
    std::vector<Image> images;
    std::vector<std::string> warnings;              // e.g. "material file x.mtl not found, using white"
    std::vector<std::filesystem::path> companions;  // files that it names and that were read: materials, textures
};

/// What the file and the repaired mesh look like, and everything repair changed. All are counts.
struct RepairReport {
    std::uint64_t source_vertices = 0, source_polygons = 0, source_triangles = 0;  // as the file has them
    std::uint64_t welded_vertices = 0;       // merged into another of equal position
    std::uint64_t isolated_vertices = 0;     // used by no face, dropped
    std::uint64_t nonfinite_vertices = 0;    // NaN or infinite
    std::uint64_t invalid_polygons = 0;      // out-of-range index, fewer than three corners, non-finite vertex
    std::uint64_t degenerate_triangles = 0;  // zero area or repeated vertex, dropped
    std::uint64_t flipped_caps = 0;          // collinear triangles given area by flipping their long edge
    std::uint64_t duplicate_triangles = 0;   // same three vertices
    std::uint64_t flipped_triangles = 0;     // turned to agree with their neighbours
    std::uint64_t inverted_triangles = 0;    // all of them, turned because the surface was inside out
    std::uint64_t computed_normals = 0;      // corners whose normal was missing or unusable
    std::uint64_t boundary_edges = 0, nonmanifold_edges = 0;  // of the repaired mesh
};

struct RepairOptions {
    // Computed normals are split where faces meet at more than this. Below the 45 degrees at which chamfers are cut.
    float crease_angle_degrees = 40.0f;
};

/// By content first, extension second: OBJ, PLY, STL, OFF, SMF, each also gzipped. Throws InputError, SystemError.
SourceMesh read_mesh_file(const std::filesystem::path& path);

/// The same for a file that is in memory already. Throws InputError.
SourceMesh parse_mesh_file(const SourceFile& file);

/// Throws InputError("name") when no triangle is left.
IndexedMesh repair_mesh(SourceMesh source, const RepairOptions& options, RepairReport& report, const std::string& name);

}  // namespace splice
