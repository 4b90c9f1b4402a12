// The graphs that are measured: families of frames that grow with their number of passes. Declaration only, so none of
// these needs a device; the renderer's own frame does (family_frame.h).
#pragma once

#include "engine/render_graph/graph.h"

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace splice::bench {

enum class ImageSizes {
    equal,        ///< every full-size image has FamilyOptions::width x height pixels
    log_uniform,  ///< square images; the logarithm of the area is uniform between the two limits, one lot a pass or
                  ///< view
};

struct FamilyOptions {
    uint32_t passes = 64;  ///< at least 4
    uint64_t seed = 1;     ///< of sizes and of the random families
    ImageSizes sizes = ImageSizes::equal;
    uint32_t width = 1920, height = 1080;                         ///< pixels
    double log2_min_pixels = 12, log2_max_pixels = 24;            ///< 64 x 64 to 4,096 x 4,096
    std::function<void(graph::Graph&, graph::Pass&)> paint = {};  ///< called last for each pass: sets what it records
};

struct Family {
    std::string_view name;
    std::string_view description;  ///< one line for --help and the report
    /// Adds options.passes passes, or as many as come in whole units. What comes out is in imported resources; images
    /// are left in layout TRANSFER_SRC_OPTIMAL.
    std::function<void(graph::Graph& graph, const FamilyOptions& options)> declare;
};

/// chain, fan, lattice, layered, layered-local, deferred: exactly options.passes passes each.
std::vector<Family> families();

/// Passes in a view of the deferred family; a graph of more has several views.
inline constexpr uint32_t kDeferredViewPasses = 32;

}  // namespace splice::bench
