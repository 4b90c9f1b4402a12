// Tables of the names by which people choose: on command lines, in scene files, in lists of the viewer.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace splice {

template <typename Value>
struct Named {
    Value value;
    std::string_view name;
    std::string_view description = {};
};

template <typename Value, std::size_t N>
using Names = std::array<Named<Value>, N>;

/// Empty for a value without a name.
template <typename Value, std::size_t N>
constexpr std::string_view name_in(const Names<Value, N>& names, Value value) {
    for (const Named<Value>& known : names)
        if (known.value == value) return known.name;
    return {};
}

template <typename Value, std::size_t N>
constexpr std::optional<Value> find_named(const Names<Value, N>& names, std::string_view name) {
    for (const Named<Value>& known : names)
        if (known.name == name) return known.value;
    return std::nullopt;
}

/// For messages: "a, b, c", each between two `quote`.
template <typename Value, std::size_t N>
std::string listed(const Names<Value, N>& names, std::string_view quote = "") {
    std::string list;
    for (const Named<Value>& known : names)
        list.append(list.empty() ? "" : ", ").append(quote).append(known.name).append(quote);
    return list;
}

}  // namespace splice
