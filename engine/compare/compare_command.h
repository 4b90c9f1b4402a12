// splice-compare's options.
#pragma once

#include "engine/compare/picture_comparison.h"

#include <filesystem>
#include <optional>

namespace splice {

struct CompareCommand {
    std::filesystem::path first, second;
    std::optional<std::filesystem::path> mask, diff, json;
    int gain = 4;
    ComparisonOptions options;
    ComparisonLimits limits;
};

/// Nothing when --help or --version was asked for and printed. Throws UsageError.
std::optional<CompareCommand> parse_compare_command(int argc, const char* const* argv);

/// Compares, prints and writes what was asked for. False if a limit does not hold. Throws InputError, SystemError.
bool run_compare(const CompareCommand& command);

}  // namespace splice
