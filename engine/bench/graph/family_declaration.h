// What the declarations of the families share: full-screen passes that sample some images and write others.
#pragma once

#include "engine/bench/graph/families.h"
#include "engine/bench/graph/random.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace splice::bench {

class FamilyBuilder {
  public:
    FamilyBuilder(graph::Graph& graph, const FamilyOptions& options)
        : graph_(&graph), options_(&options), random_(options.seed) {}

    graph::Graph& graph() { return *graph_; }
    Random& random() { return random_; }

    /// A full-size image, or one of random size.
    graph::ImageDescription description(VkFormat format) {
        if (options_->sizes == ImageSizes::equal)
            return {.format = format, .width = options_->width, .height = options_->height};
        const double span = options_->log2_max_pixels - options_->log2_min_pixels;
        const double log2_pixels = options_->log2_min_pixels + span * random_.uniform();
        // Multiples of 16: tiles of most devices, so that images have no padding.
        const uint32_t side = std::max(1U, static_cast<uint32_t>(std::lround(std::exp2(log2_pixels / 2) / 16))) * 16;
        return {.format = format, .width = side, .height = side};
    }
    graph::ImageHandle image(std::string_view name, const graph::ImageDescription& description) {
        return graph_->create_image(name, description);
    }
    /// Where a result is left for the world outside.
    graph::ImageHandle output(std::string_view name, const graph::ImageDescription& description) {
        graph::ImportOptions import;
        import.after = graph::external::transfer_read();
        return graph_->import_image(name, description, import);
    }
    graph::Pass pass(const std::string& name) { return graph_->add_pass(name, graph::PassKind::graphics); }
    /// Nothing more is declared for this pass.
    void finish(graph::Pass& pass) const {
        if (options_->paint) options_->paint(*graph_, pass);
    }
    /// One pass that samples `inputs` and overwrites `target`.
    graph::ImageHandle filter(const std::string& name, const std::vector<graph::ImageHandle>& inputs,
                              graph::ImageHandle target) {
        graph::Pass added = pass(name);
        for (const graph::ImageHandle input : inputs)
            added.sampled(input, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
        target = added.colour_attachment(target, graph::Contents::discard());
        finish(added);
        return target;
    }

  private:
    graph::Graph* graph_;
    const FamilyOptions* options_;
    Random random_;
};

void declare_layered(graph::Graph& graph, const FamilyOptions& options);
void declare_layered_local(graph::Graph& graph, const FamilyOptions& options);
void declare_deferred(graph::Graph& graph, const FamilyOptions& options);

}  // namespace splice::bench
