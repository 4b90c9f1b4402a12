// Options, determinism, spacing and the parts that the sampler is made of.
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/cover_cells.h"
#include "preprocess/surfel/grid_sampling.h"
#include "preprocess/surfel/spacing_field.h"
#include "preprocess/surfel/surface_point.h"
#include "tests/surfel/surfel_fixture.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>
#include <set>

using namespace splice;
using namespace splice::test;

namespace {

bool same_surfels(const SurfelSet& a, const SurfelSet& b) {
    const auto same = [](const SurfelSample& x, const SurfelSample& y) {
        return x.position == y.position && x.normal == y.normal && x.radius == y.radius && x.epsilon == y.epsilon &&
               x.colour == y.colour && x.shading_bend == y.shading_bend && x.clip == y.clip;
    };
    return a.patch_begin == b.patch_begin &&
           std::equal(a.surfels.begin(), a.surfels.end(), b.surfels.begin(), b.surfels.end(), same) &&
           a.stats.coverage_mean == b.stats.coverage_mean;
}

Vec3f random_point(const IndexedMesh& mesh, std::uint32_t t, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    float a = uniform(random), b = uniform(random);
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    return point_at(mesh, t, {1 - a - b, a, b});
}

std::vector<std::uint32_t> all_triangles(const IndexedMesh& mesh) {
    std::vector<std::uint32_t> triangles(mesh.triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        triangles[t] = t;
    return triangles;
}

}  // namespace

TEST_CASE("surfels do not depend on the number of threads", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(2500));
    const PatchSet patches = patches_by_cell(mesh, 4);
    for (const std::optional<double> c : {std::optional<double>{}, std::optional<double>{3.0}}) {
        SamplingOptions options;
        options.h_min = 1.0 / 128;
        options.thesis_c = c;
        std::vector<SurfelSet> sets;
        for (const std::size_t threads : {1, 2, 4}) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
            sets.push_back(sample_patches(mesh, patches, options));
        }
        CHECK(same_surfels(sets[0], sets[1]));
        CHECK(same_surfels(sets[0], sets[2]));
    }
}

TEST_CASE("models without surfel patches get no surfels", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::cube());
    PatchSet patches = one_patch(mesh);
    patches.patches[0].representation = format::Representation::kTriangles;
    const SurfelSet set = sample_patches(mesh, patches, {});
    CHECK(set.surfels.empty());
    CHECK(set.patch_begin == std::vector<std::uint64_t>{0, 0});
    CHECK(!set.stats.coverage_mean);
    CHECK(set.stats.uncovered == 0);
}

TEST_CASE("impossible spacings are usage errors", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::cube());
    const PatchSet patches = one_patch(mesh);
    const auto sample = [&](double h_min, double h_max, std::optional<double> c) {
        SamplingOptions options;
        options.h_min = h_min;
        options.h_max = h_max;
        options.thesis_c = c;
        return sample_patches(mesh, patches, options);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(sample(0, 0.1, {}), UsageError);
    CHECK_THROWS_AS(sample(-1, 0.1, {}), UsageError);
    CHECK_THROWS_AS(sample(nan, 0.1, {}), UsageError);
    CHECK_THROWS_AS(sample(0.1, nan, {}), UsageError);
    CHECK_THROWS_AS(sample(0.2, 0.1, {}), UsageError);
    CHECK_THROWS_AS(sample(0.01, 0.1, 0.0), UsageError);
    CHECK_THROWS_AS(sample(0.01, 0.1, -4.0), UsageError);
    CHECK_THROWS_AS(sample(0.01, 0.1, nan), UsageError);
}

TEST_CASE("grid samples lie within sqrt(3) h of every point, corners and borders included", "[surfel]") {
    std::mt19937 random(3);
    for (const auto& mesh : {repaired(shapes::cube()), repaired(shapes::ico_sphere(3)),
                             mesh_of({{0, 0, 0}, {1, 0.2, 0.1}, {0.3, 0.8, 0.9}}, {{0, 1, 2}})}) {
        const float h = 0.04f;
        const auto samples = sample_on_grids(mesh, all_triangles(mesh), h);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            for (int i = 0; i < 40; ++i) {
                const Vec3f point = random_point(mesh, t, random);
                float nearest = 10;
                for (const auto& sample : samples)
                    nearest = std::min(nearest, (sample.position - point).norm());
                CHECK(nearest <= std::sqrt(3.0f) * h * 1.0001f);
            }
        }
    }
    const IndexedMesh triangle = mesh_of({{0, 0, 0}, {1, 0.2, 0.1}, {0.3, 0.8, 0.9}}, {{0, 1, 2}});
    const auto samples = sample_on_grids(triangle, all_triangles(triangle), 0.1f);
    for (const auto& corner : triangle.positions) {
        CHECK(std::any_of(samples.begin(), samples.end(), [&](const GridSample& s) { return s.position == corner; }));
    }
}

TEST_CASE("a grid line through a shared edge hits once", "[surfel]") {
    // The diagonal and the outer edges of this square lie on lines of the grid.
    const IndexedMesh square = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    const auto samples = sample_on_grids(square, all_triangles(square), 0.125f);
    std::set<std::tuple<float, float, float>> distinct;
    std::size_t inner = 0;
    for (const auto& s : samples) {
        if (s.position.head<2>().cwiseAbs().maxCoeff() > 0.49f) continue;
        ++inner;
        distinct.emplace(s.position.x(), s.position.y(), s.position.z());
    }
    CHECK(inner == 49);
    CHECK(distinct.size() == 49);
}

TEST_CASE("the thesis's spacing is the mean edge over c, clamped", "[surfel]") {
    const IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}, {{0, 1, 2}});
    const auto all = all_triangles(mesh);
    CHECK(thesis_spacing(mesh, all, 4, 1e-4, 1) == Approx(0.25f));
    CHECK(thesis_spacing(mesh, all, 4, 1e-4, 0.1) == Approx(0.1f));
    CHECK(thesis_spacing(mesh, all, 100, 0.05, 1) == Approx(0.05f));
}

TEST_CASE("spacing follows curvature, colour and features within its limits", "[surfel]") {
    SamplingOptions options;
    const auto mean_spacing = [&](const IndexedMesh& mesh) {
        const SpacingField field(mesh, find_smooth_neighbours(mesh), SurfaceColour(mesh), options);
        double sum = 0;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const float s = field.at(t, point_at(mesh, t, Vec3f::Constant(1.0f / 3)));
            CHECK(s >= 0.9999f * static_cast<float>(options.h_min));
            CHECK(s <= 1.0001f * static_cast<float>(options.h_max));
            sum += s;
        }
        return sum / static_cast<double>(mesh.triangles.size());
    };
    IndexedMesh sphere = repaired(shapes::ico_sphere(24));
    const double smooth = mean_spacing(sphere), rough = mean_spacing(repaired(shapes::bumpy_sphere(12000)));
    CHECK(rough < 0.8 * smooth);

    SECTION("a flat sheet has the largest spacing inside and a small one at its border") {
        const IndexedMesh sheet = repaired(shapes::checkerboard(2, 32));
        const SpacingField field(sheet, find_smooth_neighbours(sheet), SurfaceColour(sheet), options);
        float least = 1, most = 0;
        for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t) {
            const Vec3f middle = point_at(sheet, t, Vec3f::Constant(1.0f / 3));
            least = std::min(least, field.at(t, middle));
            most = std::max(most, field.at(t, middle));
        }
        CHECK(most == Approx(options.h_max));
        CHECK(least < most / 1.5f);
    }
    SECTION("a larger sagitta doubles it on curved surfaces, a larger crease spacing at borders") {
        options.sagitta *= 0.25;
        CHECK(2 * mean_spacing(sphere) == Approx(smooth).epsilon(0.02));
        const IndexedMesh sheet = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
        const auto at_corner = [&] {
            return SpacingField(sheet, find_smooth_neighbours(sheet), SurfaceColour(sheet), options)
                .at(0, sheet.positions[sheet.triangles[0][0]]);
        };
        CHECK(at_corner() == Approx(1.0 / 400));
        options.crease_spacing = 1.0 / 100;
        CHECK(at_corner() == Approx(1.0 / 100));
    }
    SECTION("it is as wide as a ribbon, down to a limit") {
        for (const float width : {1.0f / 700, 1.0f / 900, 1.0f / 50000}) {
            const IndexedMesh ribbon =
                mesh_of({{0, 0, 0}, {1, 0, 0}, {1, width, 0}, {0, width, 0}}, {{0, 1, 2}, {0, 2, 3}});
            const SpacingField field(ribbon, find_smooth_neighbours(ribbon), SurfaceColour(ribbon), options);
            for (std::uint32_t t = 0; t < 2; ++t)
                CHECK(field.at(t, point_at(ribbon, t, Vec3f::Constant(1.0f / 3))) ==
                      Approx(std::max(width, 1.0f / 1000)).epsilon(0.01));
        }
    }
    SECTION("colour detail makes it smaller") {
        sphere.corner_colours.assign(3 * sphere.triangles.size(), 0xff808080u);
        CHECK(mean_spacing(sphere) == Approx(smooth));
        for (std::size_t c = 0; c < sphere.corner_colours.size(); ++c) {
            const Vec3f& p = sphere.positions[sphere.triangles[c / 3][c % 3]];
            sphere.corner_colours[c] = std::fmod(std::abs(p.x()) * 20, 2.0f) < 1 ? 0xff000000u : 0xffffffffu;
        }
        CHECK(mean_spacing(sphere) < 0.7 * smooth);
    }
    SECTION("so does the detail of an image, where it is") {
        // Grey but for stripes in the upper half.
        constexpr std::uint32_t kSide = 64;
        sphere.images = {{kSide, kSide, std::vector<std::uint8_t>(std::size_t{4} * kSide * kSide, 0x80)}};
        sphere.materials = {{"painted", kWhite, 0}};
        for (std::size_t c = 0; c < 3 * sphere.triangles.size(); ++c) {
            const Vec3f& p = sphere.positions[sphere.triangles[c / 3][c % 3]];
            sphere.corner_uvs.push_back({0.5f + 0.9f * p.x(), 0.5f + 0.9f * p.y()});
        }
        CHECK(mean_spacing(sphere) == Approx(smooth));
        for (std::uint32_t i = 0; i < kSide * kSide / 2; ++i)
            for (std::uint32_t k = 0; k < 3; ++k)
                sphere.images[0].rgba[4 * i + k] = i / 4 % 2 == 0 ? 0 : 255;
        CHECK(mean_spacing(sphere) < 0.8 * smooth);
        const SpacingField field(sphere, find_smooth_neighbours(sphere), SurfaceColour(sphere), options);
        double striped = 0, grey = 0;
        for (std::uint32_t t = 0; t < sphere.triangles.size(); ++t) {
            const Vec3f middle = point_at(sphere, t, Vec3f::Constant(1.0f / 3));
            (middle.y() < 0 ? striped : grey) += field.at(t, middle);
        }
        CHECK(striped < 0.5 * grey);
    }
    SECTION("the limits hold") {
        options.h_min = options.h_max = 0.03;
        CHECK(mean_spacing(sphere) == Approx(0.03));
    }
}

TEST_CASE("cells tile the patch", "[surfel]") {
    std::mt19937 random(4);
    for (const auto& [name, mesh] : awkward_meshes()) {
        INFO(name);
        const CoverCells cells(
            mesh, all_triangles(mesh), [](std::uint32_t, const Vec3f& p) { return 0.02f + 0.02f * std::abs(p.x()); },
            0.2f);
        std::vector<double> cell_area(mesh.triangles.size(), 0.0);
        for (std::size_t i = 0; i < cells.size(); ++i)
            cell_area[cells.chunks[cells.chunk_of[i]].triangle] += cells.area[i];
        bool inside = true, tiled = true;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& v = mesh.triangles[t];
            const double area = (mesh.positions[v[1]] - mesh.positions[v[0]])
                                    .cross(mesh.positions[v[2]] - mesh.positions[v[0]])
                                    .norm() /
                                2;
            tiled &= std::abs(cell_area[t] - area) <= 1e-3 * area + 1e-9;
        }
        std::uniform_real_distribution<float> uniform(0, 1);
        for (const auto& chunk : cells.chunks) {
            CoverCells::for_each_cell(chunk, [&](std::uint32_t cell, const std::array<Vec3f, 4>& corner) {
                const float a = uniform(random), b = uniform(random);
                const Vec3f point =
                    (1 - a) * ((1 - b) * corner[0] + b * corner[1]) + a * ((1 - b) * corner[2] + b * corner[3]);
                inside &= (point - cells.centre(cell)).norm() <= cells.margin[cell];
            });
        }
        CHECK(tiled);
        CHECK(inside);
    }
}

TEST_CASE("cells are not much longer than wide, whatever the triangle", "[surfel]") {
    for (const float height : {1e-5f, 1e-3f, 0.01f, 0.05f, 0.2f}) {
        for (const float foot : {0.0f, 0.1f, 0.5f, 0.97f, 1.0f}) {
            INFO("height " << height << " over " << foot);
            const IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {foot, height, 0}}, {{0, 1, 2}});
            const CoverCells cells(
                mesh, all_triangles(mesh), [](std::uint32_t, const Vec3f&) { return 0.05f; }, 0.2f);
            double area = 0;
            float longest = 0;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                area += static_cast<double>(cells.area[i]);
                longest = std::max(longest, cells.margin[i] / cells.chunks[cells.chunk_of[i]].cell_size);
            }
            CHECK(area == Approx(height / 2));
            CHECK(longest < 2);
        }
    }
}

TEST_CASE("the search finds exactly the cells that may matter", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(3000));
    const CoverCells cells(
        mesh, all_triangles(mesh), [](std::uint32_t, const Vec3f&) { return 0.05f; }, 0.2f);
    std::mt19937 random(9);
    std::uniform_int_distribution<std::size_t> pick(0, cells.size() - 1);
    for (int i = 0; i < 100; ++i) {
        const std::size_t from = pick(random);
        const Vec3f centre = cells.centre(from), normal = cells.chunks[cells.chunk_of[from]].normal;
        const float radius = 0.08f;
        std::vector<int> visited(cells.size(), 0);
        cells.for_each_range_near(centre, radius, normal, [&](std::uint32_t first, std::uint32_t end) {
            for (auto c = first; c < end; ++c)
                ++visited[c];
        });
        bool complete = true, agreed = true;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const bool agrees = cells.chunks[cells.chunk_of[c]].normal.dot(normal) >= kLeastAgreement;
            if (agrees && (cells.centre(c) - centre).norm() <= radius) complete &= visited[c] == 1;
            if (visited[c] != 0) agreed &= agrees && visited[c] == 1;
        }
        CHECK(complete);
        CHECK(agreed);
    }
}

TEST_CASE("normals of surfels lean at most 45 degrees from the face", "[surfel]") {
    IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const Vec3f face = face_normal(mesh, 0);
    mesh.corner_normals = {Vec3f(1, 0, 0.1f).normalized(), face, face};
    CHECK(surfel_normal(mesh, 0, {1, 0, 0}, face).dot(face) == Approx(std::sqrt(0.5f)));
    CHECK(surfel_normal(mesh, 0, {0, 1, 0}, face) == face);
    mesh.corner_normals = {face, -face, face};
    const Vec3f cancelled = surfel_normal(mesh, 0, {0.5f, 0.5f, 0}, face);
    CHECK(cancelled.norm() == Approx(1));
}

TEST_CASE("shading bends follow the normals of the surface", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::ico_sphere(12));  // of diameter 1, so normal = 2 position
    SamplingOptions options;
    options.h_min = options.h_max = 0.08;
    const SurfelSet set = sample_patches(mesh, one_patch(mesh), options);
    double flat = 0, bent = 0;
    for (const auto& surfel : set.surfels) {
        const auto stored =
            decode_octahedral(encode_octahedral(surfel.normal.x(), surfel.normal.y(), surfel.normal.z()));
        const TangentFrame frame = tangents_of(stored);
        const Vec3f n(stored[0], stored[1], stored[2]), s(frame.s[0], frame.s[1], frame.s[2]),
            t(frame.t[0], frame.t[1], frame.t[2]);
        std::array<float, 5> b{};
        for (std::size_t i = 0; i < b.size(); ++i)
            b[i] = static_cast<float>(surfel.shading_bend[i]) / 127.0f * format::kLargestBend[i];
        for (const auto& [u, v] : {std::pair{0.6f, 0.0f}, {-0.6f, 0.0f}, {0.0f, 0.6f}, {0.4f, -0.4f}}) {
            const Vec3f truth = (surfel.position + surfel.radius * (u * s + v * t)).normalized();
            const Vec3f fitted = (n + (b[0] + b[2] * u + b[3] * v) * s + (b[1] + b[3] * u + b[4] * v) * t).normalized();
            flat += (n - truth).squaredNorm();
            bent += (fitted - truth).squaredNorm();
        }
    }
    CHECK(bent < 0.05 * flat);
}
