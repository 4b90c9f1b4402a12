// Where light is computed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace splice {

enum class Shading : std::uint32_t {
    kSurfel,    // at surfels, to first order; colours are blended
    kDeferred,  // at pixels: normals and albedos are blended, then lit once (Botsch et al. 2005)
};

struct ShadingName {
    Shading shading;
    std::string_view name;
};

inline constexpr std::array<ShadingName, 2> kShadingNames{
    {{Shading::kSurfel, "surfel"}, {Shading::kDeferred, "deferred"}}};

constexpr std::string_view name_of(Shading shading) {
    return kShadingNames[static_cast<std::size_t>(shading)].name;
}

constexpr std::optional<Shading> shading_of_name(std::string_view name) {
    for (const ShadingName& known : kShadingNames)
        if (known.name == name) return known.shading;
    return std::nullopt;
}

}  // namespace splice
