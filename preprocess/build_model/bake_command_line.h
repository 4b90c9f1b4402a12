// splice-bake's options.
#pragma once

#include "preprocess/build_model/build_model.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace splice {

struct BakeCommand {
    std::filesystem::path input, output;
    std::optional<std::filesystem::path> stats;
    bool quiet = false;
    bool compress = false;
    BakeOptions options;
};

/// Throws UsageError when an output is the input, one of `companions` (materials and textures that the input names,
/// known once it is read) or the other output.
void check_files(const BakeCommand& command, const std::vector<std::filesystem::path>& companions = {});

/// Nothing when --help or --version was asked for and printed. Throws UsageError.
std::optional<BakeCommand> parse_bake_command(int argc, const char* const* argv);

}  // namespace splice
