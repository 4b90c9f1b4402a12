#include "tests/render_graph/random_graph.h"

#include <algorithm>
#include <random>
#include <string>

namespace splice::test {
namespace {

using graph::Contents;
using graph::PassKind;

class Tape {
  public:
    explicit Tape(const std::vector<uint32_t>& numbers) : numbers_(numbers) {}
    bool done() const { return next_ >= numbers_.size(); }
    /// 0 .. limit - 1; 0 when the tape has ended.
    uint32_t take(uint32_t limit) { return done() ? 0 : numbers_[next_++] % limit; }
    size_t size() const { return numbers_.size(); }
    /// Where a share of `count` things ends that is as large as that of the tape which was taken.
    size_t share(size_t count) const { return done() ? count : count * next_ / numbers_.size(); }

  private:
    const std::vector<uint32_t>& numbers_;
    size_t next_ = 0;
};

class Declarer {
  public:
    Declarer(graph::Graph& graph, const std::vector<uint32_t>& tape,
             const std::function<graph::RecordFunction(uint32_t pass)>& record)
        : graph_(graph), tape_(tape), record_(record) {}

    void run() {
        // A frame of many passes has many images, each in use for a while: the stuff of aliasing.
        const auto length = static_cast<uint32_t>(tape_.size());
        const uint32_t images = 2 + tape_.take(7 + length / 20), buffers = 1 + tape_.take(4 + length / 60);
        reach_ = tape_.take(3) == 0 ? UINT32_MAX : 3 + tape_.take(6);
        for (uint32_t i = 0; i < images; ++i)
            add_image(i);
        for (uint32_t i = 0; i < buffers; ++i)
            add_buffer(i);
        while (!tape_.done()) {
            add_pass();
            if (tape_.take(8) == 1) add_look();
        }
        // What is read of the last frame must be made in this one.
        for (const size_t history : histories_) {
            if (images_[history].version != 0) continue;
            graph::Pass pass = graph_.add_pass("pass" + std::to_string(passes_++), PassKind::graphics);
            if (record_) pass.record(record_(pass.index()));
            if (graph::is_depth_stencil(description(images_[history]).format)) {
                pass.depth_stencil_attachment(images_[history], Contents::clear(graph::clear_depth_stencil(0, 0)));
            } else {
                pass.colour_attachment(images_[history], Contents::clear(graph::clear_colour(0, 0, 0, 0)));
            }
        }
    }

  private:
    graph::ImportOptions import_options(bool image) {
        using namespace graph::external;
        const graph::ExternalUse written{{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT},
                                         image ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED};
        const graph::ExternalUse states[] = {none(), sampled(), transfer_read(), host_read(), written};
        graph::ImportOptions options;
        options.before = states[tape_.take(5)];
        options.after = states[tape_.take(4)];
        options.wanted = tape_.take(4) != 0;
        return options;
    }

    void add_image(uint32_t index) {
        constexpr VkFormat formats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT,
                                        VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_R8G8B8A8_UNORM};
        graph::ImageDescription description;
        description.format = formats[tape_.take(4)];
        description.width = description.height = tape_.take(4) == 0 ? 64 : 128;
        const std::string name = "image" + std::to_string(index);
        const uint32_t residence = tape_.take(16);
        if (residence == 15) {
            const graph::ImageHistory history = graph_.create_history_image(name, description, {});
            images_.push_back(history.previous);
            histories_.push_back(images_.size());
            images_.push_back(history.current);
        } else {
            images_.push_back(residence < 3 ? graph_.import_image(name, description, import_options(true))
                                            : graph_.create_image(name, description));
        }
    }

    void add_buffer(uint32_t index) {
        const std::string name = "buffer" + std::to_string(index);
        buffers_.push_back(tape_.take(4) == 0 ? graph_.import_buffer(name, {256}, import_options(false))
                                              : graph_.create_buffer(name, {256}));
    }

    /// One in reach: those in reach move on as the frame does.
    template <typename Handle>
    Handle& some(std::vector<Handle>& handles) {
        const auto count = static_cast<uint32_t>(handles.size());
        const uint32_t reach = std::min(reach_, count);
        return handles[tape_.share(count - reach) + tape_.take(reach)];
    }
    graph::ImageHandle& some_image() { return some(images_); }
    graph::BufferHandle& some_buffer() { return some(buffers_); }
    Contents some_contents(bool attachment) {
        switch (tape_.take(attachment ? 4 : 3)) {
            case 0:
                return Contents::discard();
            case 3:
                return Contents::clear(graph::clear_colour(0, 0, 0, 0));
            default:
                return Contents::keep();
        }
    }
    const graph::ImageDescription& description(graph::ImageHandle image) const {
        return graph_.declaration().resources[image.resource].image;
    }

    /// What the declaration refuses is left out: the graph must be as it was before.
    template <typename Function>
    void attempt(const Function& function) {
        try {
            function();
        } catch (const graph::GraphError&) {
        }
    }

    void add_pass() {
        const std::string name = "pass" + std::to_string(passes_++);
        constexpr PassKind kinds[] = {PassKind::compute, PassKind::transfer, PassKind::graphics, PassKind::graphics};
        graph::Pass pass = graph_.add_pass(name, kinds[tape_.take(4)]);
        if (record_) pass.record(record_(pass.index()));
        switch (graph_.declaration().passes.back().kind) {
            case PassKind::compute:
                fill_compute_pass(pass);
                break;
            case PassKind::transfer:
                fill_transfer_pass(pass);
                break;
            case PassKind::graphics:
                fill_graphics_pass(pass);
                break;
        }
    }

    /// Looks at the images in reach, so that what leads there is kept.
    void add_look() {
        graph::Pass pass = graph_.add_pass("look" + std::to_string(passes_++), PassKind::compute);
        if (record_) pass.record(record_(pass.index()));
        const size_t reach = std::min<size_t>({images_.size(), reach_, 8}), first = tape_.share(images_.size() - reach);
        for (size_t i = first; i < first + reach; ++i)
            attempt([&] { pass.sampled(images_[i]); });
        pass.side_effect();
    }

    void fill_graphics_pass(graph::Pass& pass) {
        // The first attachment sets the size that the others must have.
        graph::ImageHandle* first = &some_image();
        const graph::ImageDescription area = description(*first);
        if (graph_.declaration().resources[first->resource].history == graph::HistoryRole::previous) {
            pass.input_attachment(*first);
        } else if (graph::is_depth_stencil(area.format)) {
            *first = pass.depth_stencil_attachment(*first, Contents::clear(graph::clear_depth_stencil(0, 0)));
        } else {
            *first = pass.colour_attachment(*first, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
        }
        const uint32_t more = tape_.take(5);
        for (uint32_t i = 0; i < more; ++i)
            add_graphics_access(pass, area);
        if (tape_.take(16) == 0) pass.side_effect();
    }

    void add_graphics_access(graph::Pass& pass, const graph::ImageDescription& area) {
        graph::ImageHandle& image = some_image();
        const uint32_t choice = tape_.take(12);
        const bool same_size = description(image).width == area.width;
        if (choice < 8 && !same_size) return;
        attempt([&] {
            switch (choice) {
                case 0:
                case 1:
                    image = pass.colour_attachment(image, some_contents(true));
                    break;
                case 2:
                case 3:
                    image = pass.depth_stencil_attachment(image, some_contents(true));
                    break;
                case 4:
                    pass.depth_stencil_read(image);
                    break;
                case 5:
                case 6:
                case 7:
                    pass.input_attachment(image);
                    break;
                case 8:
                    pass.sampled(image, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
                    break;
                case 9:
                    pass.vertex_buffer(some_buffer());
                    break;
                case 10:
                    pass.index_buffer(some_buffer());
                    break;
                default: {
                    graph::BufferHandle& buffer = some_buffer();
                    buffer = pass.storage_write(buffer, some_contents(false));
                }
            }
        });
    }

    void fill_compute_pass(graph::Pass& pass) {
        const uint32_t accesses = 1 + tape_.take(4);
        for (uint32_t i = 0; i < accesses; ++i) {
            graph::ImageHandle& image = some_image();
            graph::BufferHandle& buffer = some_buffer();
            const uint32_t choice = tape_.take(9);
            attempt([&] {
                switch (choice) {
                    case 0:
                        pass.sampled(image);
                        break;
                    case 1:
                        pass.storage_read(image);
                        break;
                    case 2:
                        image = pass.storage_write(image, some_contents(false));
                        break;
                    case 3:
                        image = pass.storage_read_write(image);
                        break;
                    case 4:
                        pass.storage_read(buffer);
                        break;
                    case 5:
                        buffer = pass.storage_write(buffer, some_contents(false));
                        break;
                    case 6:
                        buffer = pass.storage_read_write(buffer);
                        break;
                    case 7:
                        pass.uniform_buffer(buffer);
                        break;
                    default:
                        pass.indirect_buffer(buffer);
                }
            });
        }
        if (tape_.take(12) == 0) pass.side_effect();
    }

    void fill_transfer_pass(graph::Pass& pass) {
        const uint32_t accesses = 1 + tape_.take(2);
        for (uint32_t i = 0; i < accesses; ++i) {
            graph::ImageHandle& image = some_image();
            graph::BufferHandle& buffer = some_buffer();
            const uint32_t choice = tape_.take(4);
            attempt([&] {
                switch (choice) {
                    case 0:
                        pass.transfer_read(image);
                        break;
                    case 1:
                        image = pass.transfer_write(image, some_contents(false));
                        break;
                    case 2:
                        pass.transfer_read(buffer);
                        break;
                    default:
                        buffer = pass.transfer_write(buffer, some_contents(false));
                }
            });
        }
    }

    graph::Graph& graph_;
    Tape tape_;
    const std::function<graph::RecordFunction(uint32_t pass)>& record_;
    std::vector<graph::ImageHandle> images_;
    std::vector<graph::BufferHandle> buffers_;
    std::vector<size_t> histories_;  // their current halves, in images_
    uint32_t passes_ = 0;
    uint32_t reach_ = UINT32_MAX;  // how many resources a pass chooses among
};

}  // namespace

void declare_random(graph::Graph& graph, const std::vector<uint32_t>& tape,
                    const std::function<graph::RecordFunction(uint32_t pass)>& record) {
    Declarer(graph, tape, record).run();
}

std::vector<uint32_t> random_tape(size_t length, uint32_t seed) {
    std::minstd_rand random(seed);
    std::vector<uint32_t> tape(length);
    for (uint32_t& number : tape)
        number = static_cast<uint32_t>(random()) >> 3;
    return tape;
}

std::vector<graph::MemoryRequirement> random_sizes(const graph::Graph& graph, uint32_t seed) {
    std::vector<graph::MemoryRequirement> sizes;
    const bool one_type = seed % 4 != 0;
    for (size_t i = 0; i < graph.declaration().resources.size(); ++i) {
        seed = seed * 1664525U + 1013904223U;
        const uint64_t size = (uint64_t{256} << (seed >> 28)) + ((seed >> 8) % 4096);
        sizes.push_back({size, uint64_t{64} << ((seed >> 20) % 4), !one_type && (seed >> 10) % 3 == 0 ? 2U : 3U});
    }
    return sizes;
}

}  // namespace splice::test
