#include "tests/support/test_files.h"

#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <stdexcept>

namespace splice::test {
namespace fs = std::filesystem;

std::optional<fs::path> model_file(const std::string& relative) {
    const char* from_environment = std::getenv("SPLICE_MODELS");
    const fs::path folder =
        from_environment ? fs::path(from_environment) : fs::path(SPLICE_SOURCE_DIR) / "../shared/models";
    const fs::path file = folder / relative;
    if (fs::exists(file)) return file;
    std::cout << "skipped: " << relative << " is not in the model folder (set SPLICE_MODELS to have it tested)\n";
    return std::nullopt;
}

fs::path source_file(const std::string& relative) {
    return fs::path(SPLICE_SOURCE_DIR) / relative;
}

fs::path program(const std::string& name) {
    return fs::path(SPLICE_BINARY_DIR) / "bin" / name;
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "splice-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot create a temporary folder like " + pattern);
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path artefact(const std::string& name) {
    const fs::path folder = fs::path(SPLICE_BINARY_DIR) / "test-artefacts";
    fs::create_directories(folder);
    return folder / name;
}

}  // namespace splice::test
