// The collection of malformed and awkward files: which are read and repaired, and which are refused with one line.
#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

using namespace splice;
using namespace splice::test;

namespace {

/// Triangles after repair, or none where the file must be refused.
using Expectation = std::optional<std::size_t>;
constexpr std::nullopt_t kRefused = std::nullopt;

const std::map<std::string, Expectation> kExpectations = {
    {"7_8ths_cube.stl", 24},
    {"blobby-shuffled.off", 4050},
    {"box_UTF16BE.obj", kRefused},
    {"box_longline.obj", 12},
    {"box_without_lineending.obj", 12},
    {"catmark_torus_creases0.obj", 64},
    {"comments.off", 12},
    {"concave_polygon.obj", 64},
    {"conrod.off", 6439},
    {"cube-ouvert.off", 10},
    {"cube-vertexcol.obj", 12},
    {"degtri_sliding.off", 5},
    {"dragon_vrip_res4.ply.gz", 10600},
    {"elephant-with-holes.off", 4463},
    {"empty.obj", kRefused},
    {"empty.ply", kRefused},
    {"empty.stl", kRefused},
    {"fan3.obj", 3},
    {"holes.off", 8288},
    {"hourglass_ico.obj", 40},
    {"invalid-face-definition.obj", kRefused},
    {"invalid-relative-vertex-index.obj", kRefused},
    {"invalid.off", kRefused},
    {"issue-140-zero-face-idx.obj", 1},
    {"issue-295-trianguation-failure.obj", 28},
    {"leading-decimal-dot-issue-201.obj", 1},
    {"malformed.obj", 7},
    {"malformed2.obj", 10},
    {"missing_material_file.obj", 36},
    {"moebius.obj", 448},
    {"mpi.off", 180},
    {"multiple_spaces.obj", 1},
    {"nancolor.obj", 12},
    {"negative_indices.obj", 12},
    {"not_convex.obj", 96},
    {"notenoughindices.obj", 1},
    {"number_formats.obj", kRefused},
    {"oblong-shuffled.off", 840},
    {"point_cloud.obj", kRefused},
    {"points_emptyface.ply", kRefused},
    {"polygonfaces.obj", 3},
    {"prim.off", 12},
    {"quads_to_stitch.off", 16},
    {"singlevn.obj", 2},
    {"soup.stl", 100},
    {"sphereWithHole.stl", 285},
    {"test-nan.obj", 34},
    {"tet-shuffled.off", 4},
    {"tetra_intersected_by_triangle.off", 5},
    {"triangle_with_empty_solid.stl", 1},
    {"triangle_with_two_solids.stl", 2},
    {"truck.obj", 4770},
    {"wallhole.obj", 66},
    {"whitespace.off", 12},
    {"zero-byte.off", kRefused},
    {"made/garbage.obj", kRefused},
    {"made/garbage.ply", kRefused},
    {"made/garbage.stl", kRefused},
    {"made/glb-bad-length.glb", kRefused},
    {"made/las-bad-header.las", kRefused},
    {"made/not-gzip.ply.gz", kRefused},
    {"made/obj-all-collinear.obj", kRefused},
    {"made/obj-all-identical.obj", kRefused},
    {"made/obj-backslash-continuation.obj", 2},
    {"made/obj-bowtie-vertex.obj", 2},
    {"made/obj-cr-only.obj", 1},
    {"made/obj-crlf-tabs-bom.obj", 1},
    {"made/obj-duplicate-and-flipped.obj", 4},
    {"made/obj-faces-before-vertices.obj", 1},
    {"made/obj-huge-and-tiny-coordinates.obj", 1},
    {"made/obj-index-out-of-range.obj", 1},
    {"made/obj-isolated-vertices.obj", 1},
    {"made/obj-missing-mtl.obj", 1},
    {"made/obj-nan-inf.obj", kRefused},
    {"made/obj-negative-index.obj", 2},
    {"made/obj-ngon-5000-one-line.obj", 4998},
    {"made/obj-no-vertices.obj", kRefused},
    {"made/obj-nonmanifold-edge-fan.obj", 4},
    {"made/obj-path-traversal-mtl.obj", 1},
    {"made/obj-two-vertex-face.obj", 1},
    {"made/obj-zero-area.obj", 1},
    {"made/off-count-mismatch.off", kRefused},
    {"made/ply-comment-and-extra-elements.ply", 2},
    {"made/ply-crlf.ply", 1},
    {"made/ply-huge-count.ply", kRefused},
    {"made/ply-index-out-of-range.ply", 1},
    {"made/ply-negative-count.ply", kRefused},
    {"made/ply-no-end-header.ply", kRefused},
    {"made/ply-truncated-binary.ply", kRefused},
    {"made/ply-unknown-format.ply", kRefused},
    {"made/points-nan-normal.xyz", kRefused},
    {"made/smf-no-header-and-junk.smf", 1},
    {"made/stl-binary-starts-with-solid.stl", 2},
    {"made/stl-count-too-large.stl", kRefused},
    {"made/stl-nan.stl", 1},
    {"made/truncated-gzip.ply.gz", kRefused},
    {"made/zero-byte.obj", kRefused},
    {"made/zero-byte.ply", kRefused},
    {"made/zero-byte.stl", kRefused},
};

}  // namespace

TEST_CASE("Broken models are repaired or refused with one line, as the table says") {
    for (const auto& [name, triangles] : kExpectations) {
        const auto file = model_file("broken/" + name);
        if (!file) continue;
        INFO(name);
        const auto bake = [&file = *file] {
            RepairReport report;
            return repair_mesh(read_mesh_file(file), {}, report, file.string());
        };
        if (triangles) {
            const IndexedMesh mesh = bake();
            CHECK(mesh.triangles.size() == *triangles);
            check_invariants(mesh);
        } else {
            const std::string message = input_error(bake);
            CHECK_THAT(message, Catch::StartsWith(file->string() + ": "));
            CHECK(message.find('\n') == std::string::npos);
            CHECK(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; }));
        }
    }
}

TEST_CASE("The table of broken models names every file of the folder") {
    const auto folder = model_file("broken");
    if (!folder) return;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
        if (!entry.is_regular_file()) continue;
        const std::string name = std::filesystem::relative(entry.path(), *folder).generic_string();
        CHECK(kExpectations.count(name) == 1);
    }
}
