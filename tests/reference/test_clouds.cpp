// Point clouds sampled from meshes: their frames held against ray casting of the meshes that the points came from.
#include "preprocess/mesh/shapes.h"
#include "tests/reference/comparison.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

using namespace splice;
using namespace splice::reference;

namespace {

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), RepairOptions{}, report, "shape");
}

// Uniform over the area, positions only, in the mesh's source units.
PointCloud sample(const IndexedMesh& mesh, std::size_t points) {
    std::vector<double> area_up_to;
    double area = 0;
    const auto corner = [&](const Triangle& t, std::size_t k) { return mesh.positions[t[k]].cast<double>().eval(); };
    for (const Triangle& t : mesh.triangles) {
        area += (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
        area_up_to.push_back(area);
    }
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0, 1);
    PointCloud cloud;
    cloud.source_points = points;
    cloud.origin = mesh.source_offset;
    for (std::size_t i = 0; i < points; ++i) {
        const auto found = std::lower_bound(area_up_to.begin(), area_up_to.end(), share(random) * area);
        const Triangle& t =
            mesh.triangles[static_cast<std::size_t>(std::min(found, area_up_to.end() - 1) - area_up_to.begin())];
        double u = share(random), v = share(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Vec3d point = corner(t, 0) + u * (corner(t, 1) - corner(t, 0)) + v * (corner(t, 2) - corner(t, 0));
        cloud.offsets.push_back((point * mesh.source_scale).cast<float>());
    }
    return cloud;
}

// Most holes that are allowed, of 100,000 pixels inside the outline.
void check_cloud_of(const std::string& name, const IndexedMesh& mesh, std::size_t points, double most_holes) {
    Renderer renderer{RendererOptions{}};
    const ReferenceScene oracle(mesh);
    BakeStats stats;
    const Model model = build_cloud_model(sample(mesh, points), {}, stats);
    const auto on_device = renderer.load(view_of(model));
    const Scene scene = scene_of(on_device);
    const std::vector<glm::dvec3> all = view_directions();
    std::size_t inside = 0, holes = 0;
    for (std::size_t i = 0; i < all.size(); i += 3) {
        CaptureSettings settings;
        settings.width = settings.height = 384;
        settings.camera = camera_from(scene.bounds(), all[i], settings.width, settings.height);
        const SurfaceCheck check = check_frame(renderer, scene, view_of(model), oracle, mesh, settings);
        INFO(name << " from direction " << i << " of 26");
        CHECK(check.iou > 0.95);
        inside += check.report.inside;
        holes += check.report.holes;
        if (check.report.holes != 0)
            write_png(test::artefact(name + "-cloud-" + std::to_string(i) + "-holes.png"), check.marked);
    }
    INFO(name << ": " << holes << " holes in " << inside << " pixels");
    CHECK(inside > 100000);
    CHECK(static_cast<double>(holes) * 100000 <= most_holes * static_cast<double>(inside));
}

}  // namespace

TEST_CASE("clouds sampled at random from smooth closed surfaces show no hole") {
    check_cloud_of("bumpy-sphere", repaired(shapes::bumpy_sphere(20000)), 60000, 0);
    check_cloud_of("torus-knot", repaired(shapes::torus_knot(2, 3, 400, 24)), 60000, 0);
}

TEST_CASE("clouds sampled at random from scans show no hole") {
    const auto bunny = test::model_file("meshes/bunny.smf");
    if (bunny) check_cloud_of("bunny", load_mesh(*bunny), 100000, 0);
}
