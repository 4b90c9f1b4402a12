#include "tests/render_graph/graph_families.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace splice::test {
namespace {

using graph::Contents;
using graph::ImageHandle;
using graph::PassKind;

class Declarer {
  public:
    Declarer(graph::Graph& graph, uint32_t seed) : graph_(graph), random_(seed) {}

    uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_() % limit); }

    graph::Pass pass() { return graph_.add_pass("pass " + std::to_string(passes_++), PassKind::graphics); }

    /// A new image, written by the pass.
    ImageHandle write(graph::Pass& pass) {
        const ImageHandle image =
            graph_.create_image("image " + std::to_string(images_++), {VK_FORMAT_R8G8B8A8_UNORM, 1920, 1080});
        return pass.colour_attachment(image, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
    }

    ImageHandle step(std::span<const ImageHandle> reads) {
        graph::Pass added = pass();
        for (const ImageHandle image : reads)
            added.sampled(image);
        return write(added);
    }

    void present(std::span<const ImageHandle> reads) {
        const ImageHandle screen = graph_.import_image("screen", {VK_FORMAT_R8G8B8A8_UNORM, 1920, 1080},
                                                       {.after = graph::external::present()});
        graph::Pass added = graph_.add_pass("present", PassKind::graphics);
        for (const ImageHandle image : reads)
            added.sampled(image);
        added.colour_attachment(screen, Contents::discard());
    }

    void chain(uint32_t passes) {
        ImageHandle last = step({});
        for (uint32_t i = 2; i < passes; ++i)
            last = step({{last}});
        present({{last}});
    }

    void fan(uint32_t passes) {
        const ImageHandle source = step({});
        std::vector<ImageHandle> middle;
        for (uint32_t i = 2; i < passes; ++i)
            middle.push_back(step({{source}}));
        present(middle);
    }

    void lattice(uint32_t passes) {
        constexpr uint32_t width = 8;
        std::vector<ImageHandle> row, next;
        for (uint32_t i = 0; i < width; ++i)
            row.push_back(step({}));
        for (uint32_t done = width; done + width < passes; done += width) {
            next.clear();
            for (uint32_t i = 0; i < width; ++i)
                next.push_back(step({{row[i], row[(i + 1) % width]}}));
            row.swap(next);
        }
        present(row);
    }

    void layered_random(uint32_t passes) {
        constexpr uint32_t width = 8;
        std::vector<ImageHandle> layers[3], layer;
        for (uint32_t done = 0; done + 1 < passes;) {
            layer.clear();
            for (uint32_t i = 0; i < width && done + 1 < passes; ++i, ++done) {
                graph::Pass added = pass();
                read_earlier(added, layers);
                for (uint32_t writes = 1 + below(2); writes > 0; --writes)
                    layer.push_back(write(added));
            }
            layers[0].swap(layers[1]);
            layers[1].swap(layers[2]);
            layers[2].swap(layer);
        }
        present(layers[2]);
    }

    void deferred(uint32_t passes) {
        std::vector<ImageHandle> views;
        for (uint32_t done = 0; done + 1 < passes;) {
            const std::vector<ImageHandle> shadows{step({}), step({}), step({})};
            graph::Pass geometry = pass();
            std::vector<ImageHandle> lit = shadows;
            for (int i = 0; i < 4; ++i)
                lit.push_back(write(geometry));
            const ImageHandle occlusion = step({{lit[3], lit[4]}});
            lit.push_back(step({{occlusion}}));
            ImageHandle colour = step(lit);
            done += 7;
            for (uint32_t i = 4 + below(8); i > 0 && done + 1 < passes; --i, done += 2) {
                const ImageHandle half = step({{colour}});
                colour = step({{half, colour}});
            }
            views.push_back(colour);
        }
        present(views);
    }

  private:
    void read_earlier(graph::Pass& added, std::span<const std::vector<ImageHandle>> layers) {
        const size_t available = layers[0].size() + layers[1].size() + layers[2].size();
        std::vector<ImageHandle> read;
        for (uint32_t reads = 2 + below(2); reads > 0 && read.size() < available;) {
            const std::vector<ImageHandle>& from = layers[below(3)];
            if (from.empty()) continue;
            const ImageHandle image = from[below(static_cast<uint32_t>(from.size()))];
            if (std::find(read.begin(), read.end(), image) != read.end()) continue;
            added.sampled(image);
            read.push_back(image);
            --reads;
        }
    }

    graph::Graph& graph_;
    std::mt19937 random_;
    uint32_t passes_ = 0, images_ = 0;
};

}  // namespace

std::string_view name_of(Family family) {
    switch (family) {
        case Family::chain:
            return "chain";
        case Family::fan:
            return "fan";
        case Family::lattice:
            return "lattice";
        case Family::layered_random:
            return "layered random";
        case Family::deferred:
            return "deferred";
    }
    return "";
}

void declare_family(graph::Graph& graph, Family family, uint32_t passes, uint32_t seed) {
    Declarer declarer(graph, seed);
    switch (family) {
        case Family::chain:
            return declarer.chain(passes);
        case Family::fan:
            return declarer.fan(passes);
        case Family::lattice:
            return declarer.lattice(passes);
        case Family::layered_random:
            return declarer.layered_random(passes);
        case Family::deferred:
            return declarer.deferred(passes);
    }
}

std::vector<graph::MemoryRequirement> log_uniform_sizes(const graph::Graph& graph, uint32_t seed, uint64_t alignment) {
    std::mt19937 random(seed);
    std::vector<graph::MemoryRequirement> sizes;
    for (size_t i = 0; i < graph.declaration().resources.size(); ++i) {
        const double octave = 12 + 14 * static_cast<double>(random()) / 4294967296.0;
        const auto bytes = static_cast<uint64_t>(std::exp2(octave));
        sizes.push_back({(bytes + alignment - 1) / alignment * alignment, alignment, 1});
    }
    return sizes;
}

}  // namespace splice::test
