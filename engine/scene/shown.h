// Which representation of a model is drawn, whatever its bake chose.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace splice {

enum class Shown : std::uint32_t {
    kHybrid,     // as baked
    kTriangles,  // surfel patches, too, by the triangles that they were sampled from
    kSurfels,    // surfel patches alone
};

struct ShownName {
    Shown shown;
    std::string_view name;
    std::string_view description;
};

inline constexpr std::array<ShownName, 3> kShownNames{{{Shown::kHybrid, "hybrid", "as baked"},
                                                       {Shown::kTriangles, "triangles", "every patch by its triangles"},
                                                       {Shown::kSurfels, "surfels", "surfel patches alone"}}};

constexpr std::string_view name_of(Shown shown) {
    return kShownNames[static_cast<std::size_t>(shown)].name;
}

constexpr std::optional<Shown> shown_of_name(std::string_view name) {
    for (const ShownName& known : kShownNames)
        if (known.name == name) return known.shown;
    return std::nullopt;
}

}  // namespace splice
