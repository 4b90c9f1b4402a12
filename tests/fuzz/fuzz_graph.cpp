// The declaration of a frame from bytes, well used or not: each call either does its work or throws a GraphError that
// names pass and resource. What compile() accepts has no hazard and keeps exactly the passes that something needs; the
// same bytes, declared again, have the same key and the same plan.
#include "engine/render_graph/compile.h"
#include "tests/render_graph/hazard_checker.h"
#include "tests/render_graph/plan_checker.h"

#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace splice;
using graph::Contents;
using graph::Pass;
using graph::PassKind;

class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    bool done() const { return next_ >= size_; }
    std::uint32_t take(std::uint32_t limit) { return done() ? 0 : data_[next_++] % limit; }

  private:
    const std::uint8_t* data_;
    std::size_t size_, next_ = 0;
};

void require(bool holds, const std::string& what) {
    if (holds) return;
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

class Declarer {
  public:
    explicit Declarer(Bytes& bytes) : bytes_(bytes) {}

    void run(graph::Graph& graph) {
        graph_id_ = graph.id();
        constexpr std::uint32_t kMost = 48;  // of resources and of passes: the checker's time
        while (!bytes_.done()) {
            const std::uint32_t choice = bytes_.take(8);
            if (choice < 2) {
                if (graph.declaration().resources.size() < kMost) create(graph);
            } else if (choice == 2) {
                if (passes_.size() < kMost) add_pass(graph);
            } else if (!passes_.empty()) {
                // Now and then a pass that is complete.
                Pass& pass = passes_[bytes_.take(16) == 0 ? 0 : passes_.size() - 1];
                attempt("pass 'p", [&] { access(pass); });
            }
        }
    }

    /// Runs it; a GraphError must say where.
    template <typename Function>
    static void attempt(const std::string& where, const Function& function) {
        try {
            function();
        } catch (const graph::GraphError& error) {
            const std::string message = error.what();
            require(message.find(where) != std::string::npos, "a message without " + where + ": " + message);
            require(message.find(';') != std::string::npos || where != "pass 'p" ||
                        message.find("at least") != std::string::npos,
                    "a message without a way out: " + message);
        }
    }

  private:
    graph::ImportOptions import_options() {
        using namespace graph::external;
        const graph::ExternalUse uses[] = {none(), sampled(), transfer_read(), host_read(), present()};
        return {uses[bytes_.take(5)], uses[bytes_.take(5)], bytes_.take(2) == 0};
    }

    void add_pass(graph::Graph& graph) {
        const auto kind = static_cast<PassKind>(bytes_.take(3));
        passes_.push_back(graph.add_pass("p" + std::to_string(passes_.size()), kind));
        if (kind != PassKind::graphics || images_.empty() || bytes_.take(24) == 0) return;
        // An attachment, without which it is refused.
        const std::size_t first = bytes_.take(64);
        for (std::size_t i = 0; i < images_.size() && graph.accesses(passes_.back().index()).empty(); ++i) {
            graph::ImageHandle& image = images_[(first + i) % images_.size()];
            attempt("pass 'p", [&] {
                const bool depth = graph::is_depth_stencil(graph.declaration().resources[image.resource].image.format);
                image = depth ? passes_.back().depth_stencil_attachment(image, Contents::clear({}))
                              : passes_.back().colour_attachment(image, Contents::clear({}));
            });
        }
    }

    void create(graph::Graph& graph) {
        constexpr VkFormat formats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_R32_SFLOAT,
                                        VK_FORMAT_UNDEFINED};
        // Mostly of one size, as one pass with another kind of mistake is all it takes to be refused.
        const auto rarely = [&](std::uint32_t value) { return bytes_.take(24) == 0 ? value : 0; };
        const graph::ImageDescription image{formats[rarely(2) + bytes_.take(2)],
                                            2 - rarely(2),
                                            2 - rarely(1),
                                            1 + rarely(1),
                                            1 + rarely(1),
                                            rarely(1) != 0 ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT};
        const graph::BufferDescription buffer{bytes_.take(24)};
        const std::string name = "r" + std::to_string(graph.declaration().resources.size());
        attempt("'r", [&] {
            switch (bytes_.take(6)) {
                case 0:
                    images_.push_back(graph.create_image(name, image));
                    break;
                case 1:
                    images_.push_back(graph.import_image(name, image, import_options()));
                    break;
                case 2: {
                    const graph::ImageHistory history = graph.create_history_image(name, image, {});
                    images_.insert(images_.end(), {history.previous, history.current});
                    break;
                }
                case 3:
                    buffers_.push_back(graph.create_buffer(name, buffer));
                    break;
                case 4:
                    buffers_.push_back(graph.import_buffer(name, buffer, import_options()));
                    break;
                default: {
                    const graph::BufferHistory history = graph.create_history_buffer(name, buffer);
                    buffers_.insert(buffers_.end(), {history.previous, history.current});
                }
            }
        });
    }

    /// Mostly a handle that is good; also stale ones, ones from the future, and ones of nothing.
    template <typename Handle>
    Handle& some(std::vector<Handle>& handles) {
        const std::uint32_t at = bytes_.take(64);
        spoiled<Handle>() =
            handles.empty() ? Handle{at, 0, bytes_.take(2) == 0 ? graph_id_ : 0} : handles[at % handles.size()];
        switch (handles.empty() ? 0 : bytes_.take(24)) {
            case 0:
                return spoiled<Handle>();
            case 1:
                --spoiled<Handle>().version;
                return spoiled<Handle>();
            case 2:
                ++spoiled<Handle>().version;
                return spoiled<Handle>();
            case 3:
                spoiled<Handle>().resource += at;
                return spoiled<Handle>();
            default:
                return handles[at % handles.size()];
        }
    }
    template <typename Handle>
    Handle& spoiled() {
        if constexpr (std::is_same_v<Handle, graph::ImageHandle>) {
            return spoiled_image_;
        } else {
            return spoiled_buffer_;
        }
    }

    Contents contents() {
        const Contents all[] = {Contents::keep(), Contents::discard(), Contents::clear({})};
        return all[bytes_.take(3)];
    }
    VkPipelineStageFlags stages() {
        constexpr VkPipelineStageFlags all[] = {0, 0, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT,
                                                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT};
        return all[bytes_.take(5)];
    }

    void access(Pass& pass) {
        graph::ImageHandle& image = some(images_);
        graph::BufferHandle& buffer = some(buffers_);
        switch (bytes_.take(20)) {
            case 0:
            case 1:
                image = pass.colour_attachment(image, contents());
                break;
            case 2:
                image = pass.depth_stencil_attachment(image, contents());
                break;
            case 3:
                pass.depth_stencil_read(image);
                break;
            case 4:
                pass.input_attachment(image);
                break;
            case 5:
                pass.sampled(image, stages());
                break;
            case 6:
                pass.storage_read(image, stages());
                break;
            case 7:
                pass.storage_read(buffer, stages());
                break;
            case 8:
                image = pass.storage_write(image, contents(), stages());
                break;
            case 9:
                buffer = pass.storage_write(buffer, contents(), stages());
                break;
            case 10:
                image = pass.storage_read_write(image, stages());
                break;
            case 11:
                buffer = pass.storage_read_write(buffer, stages());
                break;
            case 12:
                pass.uniform_buffer(buffer, stages());
                break;
            case 13:
                pass.vertex_buffer(buffer);
                break;
            case 14:
                pass.index_buffer(buffer);
                break;
            case 15:
                pass.indirect_buffer(buffer);
                break;
            case 16:
                pass.transfer_read(image);
                break;
            case 17:
                image = pass.transfer_write(image, contents());
                break;
            case 18:
                buffer = pass.transfer_write(buffer, contents());
                break;
            default:
                pass.side_effect();
        }
    }

    Bytes& bytes_;
    uint32_t graph_id_ = 0;
    std::vector<graph::ImageHandle> images_;
    std::vector<graph::BufferHandle> buffers_;
    graph::ImageHandle spoiled_image_;
    graph::BufferHandle spoiled_buffer_;
    std::vector<Pass> passes_;
};

graph::CompileOptions read_options(Bytes& bytes) {
    graph::CompileOptions options;
    const std::uint32_t switches = bytes.take(64);
    options.cull = (switches & 1) == 0;
    options.merge = (switches & 2) == 0;
    options.alias = (switches & 4) == 0;
    options.batch_barriers = (switches & 8) == 0;
    if ((switches & 16) != 0) options.random_order = bytes.take(256);
    return options;
}

void require_same(const graph::Graph& one, const graph::Graph& other, const graph::Plan& plan,
                  const graph::CompileOptions& options) {
    require(one.key() == other.key(), "two declarations of the same bytes have different keys");
    require(graph::compile(other, options) == plan, "two declarations of the same bytes have different plans");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    graph::CompileOptions options = read_options(bytes);
    std::vector<graph::MemoryRequirement> memory;
    options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return memory[resource]; };
    graph::Graph graph;
    Declarer(bytes).run(graph);
    for (uint64_t resource = 0; resource < graph.declaration().resources.size(); ++resource)
        memory.push_back({100 + resource * resource * 37 % 1000, 64, 1});
    Declarer::attempt("pass 'p", [&] {
        const graph::Plan plan = graph::compile(graph, options);
        for (const std::string& problem : test::find_hazards(graph, plan, memory))
            require(false, problem);
        if (options.cull) {
            const std::set<uint32_t> kept(plan.order.begin(), plan.order.end());
            require(kept == test::needed_passes(graph), "other passes are kept than something needs");
        }
        Bytes again(data, size);
        read_options(again);
        graph::Graph other;
        Declarer(again).run(other);
        require_same(graph, other, plan, options);
    });
    return 0;
}
