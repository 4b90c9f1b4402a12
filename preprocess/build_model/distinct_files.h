// A slip on a command line must not cost a file: what a program writes is checked against what it reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace splice {

struct NamedFile {
    std::string name;  // as the user knows it: "INPUT", "--stats"
    std::filesystem::path path;
};

/// Throws UsageError when an output is an input or another output, however the two are spelled: relative or absolute,
/// through "." and "..", links to folders or files, existing or not. Inputs may repeat.
void check_distinct_files(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace splice
