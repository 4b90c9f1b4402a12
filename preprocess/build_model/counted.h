// Numbers of things in reports for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace splice {

/// 1234567 -> "1,234,567"
inline std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
        digits.insert(static_cast<std::size_t>(place), 1, ',');
    return digits;
}

/// "1 vertex", "1,234 vertices"
inline std::string counted(std::uint64_t number, std::string_view one, std::string_view many) {
    return grouped(number).append(" ").append(number == 1 ? one : many);
}

/// "1 surfel", "1,234 surfels"
inline std::string counted(std::uint64_t number, const std::string& one) {
    return counted(number, one, one + "s");
}

}  // namespace splice
