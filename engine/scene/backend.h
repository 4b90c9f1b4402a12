// How splats reach the accumulation: sets of passes that fill the same target and are held to the same pictures.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace splice {

enum class Backend : std::uint32_t {
    kAuto,    // the fastest on the device that can draw the view
    kSprite,  // point sprites and quads, rasterised: the reference
    kTile,    // compute: splats listed by screen tile, both surfel passes gathered in one go
};

struct BackendName {
    Backend backend;
    std::string_view name;
};

inline constexpr std::array<BackendName, 3> kBackendNames{
    {{Backend::kAuto, "auto"}, {Backend::kSprite, "sprite"}, {Backend::kTile, "tile"}}};

constexpr std::string_view name_of(Backend backend) {
    return kBackendNames[static_cast<std::size_t>(backend)].name;
}

constexpr std::optional<Backend> backend_of_name(std::string_view name) {
    for (const BackendName& known : kBackendNames)
        if (known.name == name) return known.backend;
    return std::nullopt;
}

}  // namespace splice
