// Loading on another thread: progress, results, failures, and being abandoned. ThreadSanitizer's business, too.
#include "engine/viewer/scene_job.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/mesh/write_mesh.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <chrono>
#include <fstream>
#include <thread>

using namespace splice;

namespace {

SceneJob::Outcome outcome_of(SceneJob& job) {
    for (;;) {
        job.progress();
        if (auto outcome = job.take_outcome()) return std::move(*outcome);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

SceneRequest request_for(const std::filesystem::path& path) {
    return {{path}, {.bake = {}, .threads = 1}, false};
}

}  // namespace

TEST_CASE("a mesh is baked on another thread, as it would be on this one") {
    const test::TemporaryFolder folder;
    write_ply(shapes::torus_knot(2, 3, 40, 10), folder / "knot.ply");
    SceneJob job(request_for(folder / "knot.ply"));
    const SceneJob::Outcome outcome = outcome_of(job);
    REQUIRE(outcome.scene);
    CHECK(outcome.error == "");
    CHECK_FALSE(job.take_outcome());
    REQUIRE(outcome.scene->models.size() == 1);
    CHECK(outcome.scene->models[0]->baked());
    const PreparedScene here = prepare_scene({folder / "knot.ply"});
    CHECK(outcome.scene->models[0]->view().surfel_count() == here.models[0]->view().surfel_count());
    CHECK(outcome.scene->models[0]->view().info->drawn_triangles == here.models[0]->view().info->drawn_triangles);
    CHECK_FALSE(job.progress().stage.empty());
}

TEST_CASE("options replace those of the scene") {
    const test::TemporaryFolder folder;
    write_ply(shapes::torus_knot(2, 3, 40, 10), folder / "knot.ply");
    SceneRequest request = request_for(folder / "knot.ply");
    request.options.bake = BakeOptions{};
    request.options.bake->cluster.representation = ForcedRepresentation::kTriangles;
    SceneJob job(request);
    const SceneJob::Outcome outcome = outcome_of(job);
    REQUIRE(outcome.scene);
    CHECK(outcome.scene->models[0]->view().surfels.empty());
}

TEST_CASE("what cannot be read is told, and nothing else happens") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "broken.ply") << "ply\nnonsense\n";
    SceneJob broken(request_for(folder / "broken.ply"));
    const SceneJob::Outcome outcome = outcome_of(broken);
    CHECK_FALSE(outcome.scene);
    CHECK_THAT(outcome.error, Catch::Contains("broken.ply"));
    SceneJob missing(request_for(folder / "missing.ply"));
    CHECK_THAT(outcome_of(missing).error, Catch::Contains("cannot read"));
}

TEST_CASE("a job that nobody waits for ends with its owner") {
    const test::TemporaryFolder folder;
    write_ply(shapes::bumpy_sphere(20000), folder / "sphere.ply");
    for (int i = 0; i < 3; ++i) {
        SceneJob job(request_for(folder / "sphere.ply"));
        std::this_thread::sleep_for(std::chrono::milliseconds(20 * i));
    }
    SUCCEED();
}
