// The meshes that splice-bench runs on, and what the thesis published about some of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace splice::bench {

/// Ni 2005, tables 4.3 and 4.4: GeForce FX 5950 Ultra, 512x512.
struct Published {
    double triangles_in, triangles_kept, surfels;
    double bake_seconds;  // clustering and sampling
    double surfels_per_pixel;
    double hybrid_fps, triangle_fps;
};

struct BenchModel {
    std::filesystem::path path;
    std::string name;
    std::optional<Published> published;
};

/// The given files; when there are none, the thesis's five models in `folder`/meshes and the bunny of Debian's package
/// glmark2-data, those that exist. Throws UsageError when a given file does not exist or nothing is found.
std::vector<BenchModel> bench_models(const std::vector<std::filesystem::path>& files,
                                     const std::filesystem::path& folder);

}  // namespace splice::bench
