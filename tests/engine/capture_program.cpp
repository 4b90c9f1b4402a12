#include "tests/engine/capture_program.h"

#include "tests/engine/handmade_model.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace splice::test {

Outcome capture(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    return run({.program = program("splice-capture"), .arguments = arguments, .folder = folder.path()});
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

void write_small_model(const std::filesystem::path& path) {
    HandmadeModel model;
    model.add_surfels(sheet({-0.5f, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, 8, kRed));
    model.add_triangles(quad({0, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, kGreen));
    write_model(view_of(model.model()), path);
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace splice::test
