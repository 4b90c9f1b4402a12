// Runs of splice-capture in a folder of their own, and what they need there.
#pragma once

#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <filesystem>
#include <string>
#include <vector>

namespace splice::test {

Outcome capture(const TemporaryFolder& folder, const std::vector<std::string>& arguments);

/// A red sheet of surfels beside a green quad of triangles.
void write_small_model(const std::filesystem::path& path);

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

/// Their names, sorted.
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace splice::test
