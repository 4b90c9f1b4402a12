// The collection of malformed and awkward files: which are read and repaired, and which are refused with one line.
#include "tests/mesh/broken_models.h"
#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <algorithm>
#include <filesystem>

using namespace splice;
using namespace splice::test;

TEST_CASE("Broken models are repaired or refused with one line, as the table says") {
    for (const auto& [name, triangles] : kBrokenModels) {
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
        CHECK(kBrokenModels.count(name) == 1);
    }
}
