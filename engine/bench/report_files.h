// What a benchmark writes is checked before it begins: it takes minutes, and must not cost a file that it reads.
#pragma once

#include "preprocess/build_model/distinct_files.h"

#include <filesystem>
#include <string>
#include <vector>

namespace splice::bench {

/// All under one name.
std::vector<NamedFile> named_files(const std::string& name, const std::vector<std::filesystem::path>& paths);

/// The same with the models of those that are scenes. Throws UsageError where there is no file, InputError,
/// SystemError.
std::vector<NamedFile> files_of_scenes(const std::string& name, const std::vector<std::filesystem::path>& paths);

/// Outputs can be created, and none is an input or another output. Files without a path are left out. Throws
/// UsageError, SystemError.
void check_report_files(std::vector<NamedFile> inputs, std::vector<NamedFile> outputs);

}  // namespace splice::bench
