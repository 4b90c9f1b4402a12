#include "engine/bench/graph/families.h"

#include "engine/bench/graph/family_declaration.h"

#include <cmath>
#include <string>

namespace splice::bench {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

/// Each pass samples the image of the one before.
void declare_chain(graph::Graph& graph, const FamilyOptions& options) {
    FamilyBuilder builder(graph, options);
    std::vector<graph::ImageHandle> previous;
    for (uint32_t i = 0; i + 1 < options.passes; ++i) {
        const std::string number = std::to_string(i);
        previous = {builder.filter("filter " + number, previous,
                                   builder.image("image " + number, builder.description(kFormat)))};
    }
    builder.filter("present", previous, builder.output("picture", builder.description(kFormat)));
}

/// One source, passes - 2 that sample it, one that samples all of them.
void declare_fan(graph::Graph& graph, const FamilyOptions& options) {
    FamilyBuilder builder(graph, options);
    const graph::ImageHandle source =
        builder.filter("source", {}, builder.image("source", builder.description(kFormat)));
    std::vector<graph::ImageHandle> results;
    for (uint32_t i = 0; i + 2 < options.passes; ++i) {
        const std::string number = std::to_string(i);
        results.push_back(builder.filter("branch " + number, {source},
                                         builder.image("branch " + number, builder.description(kFormat))));
    }
    builder.filter("gather", results, builder.output("picture", builder.description(kFormat)));
}

/// A square grid, in rows: each pass samples its left and its upper neighbour, so the number of paths from the first to
/// the last grows exponentially. The last pass samples whatever nobody else does.
void declare_lattice(graph::Graph& graph, const FamilyOptions& options) {
    FamilyBuilder builder(graph, options);
    const uint32_t cells = options.passes - 1;
    const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(cells))));
    std::vector<graph::ImageHandle> images;
    std::vector<bool> sampled(cells, false);
    for (uint32_t cell = 0; cell < cells; ++cell) {
        std::vector<graph::ImageHandle> inputs;
        const auto read = [&](uint32_t neighbour) {
            inputs.push_back(images[neighbour]);
            sampled[neighbour] = true;
        };
        if (cell % columns != 0) read(cell - 1);
        if (cell >= columns) read(cell - columns);
        const std::string number = std::to_string(cell / columns) + "," + std::to_string(cell % columns);
        images.push_back(
            builder.filter("cell " + number, inputs, builder.image("cell " + number, builder.description(kFormat))));
    }
    std::vector<graph::ImageHandle> ends;
    for (uint32_t cell = 0; cell < cells; ++cell) {
        if (!sampled[cell]) ends.push_back(images[cell]);
    }
    builder.filter("present", ends, builder.output("picture", builder.description(kFormat)));
}

}  // namespace

std::vector<Family> families() {
    return {
        {"chain", "each pass samples the image of the one before", declare_chain},
        {"fan", "one source, N - 2 passes that sample it, one that samples them all", declare_fan},
        {"lattice", "a square grid; each pass samples its left and its upper neighbour", declare_lattice},
        {"layered", "random: layers of 8; each pass samples 2-3 images of the 3 layers before, writes 1-2",
         declare_layered},
        {"layered-local", "the same in 4 sizes, half of the reads of the own pixel only, so that passes merge",
         declare_layered_local},
        {"deferred", "views of 32 passes: shadows, G-buffer, lights, ambient occlusion, bloom, tone map",
         declare_deferred},
    };
}

}  // namespace splice::bench
