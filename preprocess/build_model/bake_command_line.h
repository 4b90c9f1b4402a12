// splice-bake's options.
#pragma once

#include "preprocess/build_model/build_model.h"

#include <filesystem>
#include <optional>

namespace splice {

struct BakeCommand {
    std::filesystem::path input, output;
    std::optional<std::filesystem::path> stats;
    bool quiet = false;
    BakeOptions options;
};

/// Nothing when --help or --version was asked for and printed. Throws UsageError.
std::optional<BakeCommand> parse_bake_command(int argc, const char* const* argv);

}  // namespace splice
