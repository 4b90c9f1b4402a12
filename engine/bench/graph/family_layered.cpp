// Layers of 8 passes. Each pass reads 2 or 3 images of the previous three layers and writes 1 or 2; the last pass reads
// what nobody has read. The first read of a pass takes an image of a pass that has no reader
// yet, while there is one in reach, so that culling cannot make the graph smaller than it says.
#include "engine/bench/graph/family_declaration.h"

#include <algorithm>

namespace splice::bench {
namespace {

constexpr uint32_t kLayer = 8, kLayersInReach = 3;
constexpr uint32_t kLocalSizes = 4;  // passes merge only where their sizes are the same
constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

struct Image {
    graph::ImageHandle handle;
    uint32_t pass;
    graph::ImageDescription description;
};

class LayeredBuilder {
  public:
    LayeredBuilder(graph::Graph& graph, const FamilyOptions& options, bool local)
        : builder_(graph, options), local_(local), passes_(options.passes), read_(options.passes, false) {
        for (uint32_t i = 0; local && i < kLocalSizes; ++i)
            sizes_.push_back(builder_.description(kFormat));
    }

    void declare() {
        for (uint32_t pass = 0; pass + 1 < passes_; ++pass) {
            if (pass % kLayer == 0) first_in_layer_.push_back(images_.size());
            add(pass);
        }
        std::vector<graph::ImageHandle> unread;
        for (size_t i = 0; i < images_.size(); ++i) {
            const bool first_of_pass = i == 0 || images_[i - 1].pass != images_[i].pass;
            if (!read_[images_[i].pass] && first_of_pass) unread.push_back(images_[i].handle);
        }
        const auto picture = builder_.output("picture", builder_.description(kFormat));
        builder_.filter("present", unread, picture);
    }

  private:
    void add(uint32_t pass) {
        Random& random = builder_.random();
        const std::vector<size_t> inputs = choose_inputs(pass);
        const auto size = local_ ? sizes_[random.below(kLocalSizes)] : builder_.description(kFormat);
        const std::string number = std::to_string(pass / kLayer) + "." + std::to_string(pass % kLayer);
        const uint32_t writes = 1 + random.below(2);
        const auto a = builder_.image("image " + number, size);
        const auto b = writes > 1 ? builder_.image("image " + number + "b", size) : graph::ImageHandle{};

        graph::Pass added = builder_.pass("pass " + number);
        for (const size_t input : inputs) {
            const bool local = local_ && random.below(2) == 0 && images_[input].description == size;
            if (local) {
                added.input_attachment(images_[input].handle);
            } else {
                added.sampled(images_[input].handle, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
            }
        }
        images_.push_back({added.colour_attachment(a, graph::Contents::discard()), pass, size});
        if (writes > 1) images_.push_back({added.colour_attachment(b, graph::Contents::discard()), pass, size});
        builder_.finish(added);
    }

    /// Into images_; different ones, of the layers in reach.
    std::vector<size_t> choose_inputs(uint32_t pass) {
        const uint32_t layer = pass / kLayer;
        std::vector<size_t> inputs;
        if (layer == 0) return inputs;
        const size_t begin = first_in_layer_[layer - std::min(layer, kLayersInReach)], end = first_in_layer_[layer];
        const size_t count = std::min<size_t>(2 + builder_.random().below(2), end - begin);
        for (size_t i = begin; i < end && inputs.empty(); ++i) {
            if (!read_[images_[i].pass]) inputs.push_back(i);
        }
        while (inputs.size() < count) {
            const size_t input = begin + builder_.random().below(static_cast<uint32_t>(end - begin));
            if (std::find(inputs.begin(), inputs.end(), input) == inputs.end()) inputs.push_back(input);
        }
        for (const size_t input : inputs)
            read_[images_[input].pass] = true;
        return inputs;
    }

    FamilyBuilder builder_;
    bool local_;
    uint32_t passes_;
    std::vector<graph::ImageDescription> sizes_;
    std::vector<Image> images_;
    std::vector<bool> read_;              // one a pass: any of its images
    std::vector<size_t> first_in_layer_;  // into images_
};

}  // namespace

void declare_layered(graph::Graph& graph, const FamilyOptions& options) {
    LayeredBuilder(graph, options, false).declare();
}

void declare_layered_local(graph::Graph& graph, const FamilyOptions& options) {
    LayeredBuilder(graph, options, true).declare();
}

}  // namespace splice::bench
