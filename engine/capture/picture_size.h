// The value of --size, of every program.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace splice {

/// "WIDTHxHEIGHT" in pixels, both above 0. Throws UsageError.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text);

}  // namespace splice
