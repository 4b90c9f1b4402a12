// Declaration of a frame: resources, passes, and what each pass does to each resource. Nothing is created here;
// compile() (compile.h) derives order, merging, layouts and barriers, and the Executor (executor/executor.h) runs the
// result.
//
// Handles are versioned. A write returns the handle of the new contents and makes the old handle stale, so the order in
// which passes are declared is a valid order, a cycle cannot be expressed, and using contents that no longer exist
// fails on the spot with the names of pass and resource.
//
// The frame of the renderer, which becomes one VkRenderPass of four subpasses and a copy:
//
//   graph::Graph frame;
//   auto colour = frame.create_image("colour", {VK_FORMAT_R8G8B8A8_SRGB, width, height});
//   auto depth = frame.create_image("depth", {device.depth_stencil_format(), width, height});
//   auto accumulation = frame.create_image("accumulation", {VK_FORMAT_R32G32B32A32_SFLOAT, width, height});
//   auto image = frame.create_image("image", {VK_FORMAT_R8G8B8A8_SRGB, width, height});
//   auto pixels = frame.import_buffer("pixels", {width * height * 4}, {.after = external::host_read()});
//
//   auto triangles = frame.add_pass("triangle", graph::PassKind::graphics);
//   colour = triangles.colour_attachment(colour, Contents::clear(clear_colour(0, 0, 0, 1)));
//   depth = triangles.depth_stencil_attachment(depth, Contents::clear(clear_depth_stencil(0, 0)));
//   triangles.record([&](const graph::PassContext& context) { draw_triangles(context); });
//
//   auto visibility = frame.add_pass("surfel_visibility", graph::PassKind::graphics);
//   depth = visibility.depth_stencil_attachment(depth, Contents::keep());
//
//   auto attributes = frame.add_pass("surfel_attribute", graph::PassKind::graphics);
//   accumulation = attributes.colour_attachment(accumulation, Contents::clear(clear_colour(0, 0, 0, 0)));
//   attributes.depth_stencil_read(depth);
//
//   auto normalise = frame.add_pass("surfel_normalise", graph::PassKind::graphics);
//   normalise.input_attachment(colour);        // input_attachment_index = 0
//   normalise.input_attachment(accumulation);  // input_attachment_index = 1
//   normalise.depth_stencil_read(depth);       // stencil test; also allowed: input_attachment(depth)
//   image = normalise.colour_attachment(image, Contents::discard());
//
//   auto copy = frame.add_pass("read_back", graph::PassKind::transfer);
//   copy.transfer_read(image);
//   pixels = copy.transfer_write(pixels, Contents::discard());
//   copy.record([&](const graph::PassContext& context) { vkCmdCopyImageToBuffer(context.commands, ...); });
//
// Buffers and textures that no command of the frame writes (geometry, uniforms) need not be declared.
#pragma once

#include "engine/render_graph/access.h"
#include "engine/render_graph/declaration_key.h"
#include "engine/render_graph/error.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace splice::graph {

class Graph;
struct PassContext;  // executor/pass_context.h

/// The contents of an image at one point of the frame.
struct ImageHandle {
    uint32_t resource = UINT32_MAX;
    uint32_t version = 0;
    uint32_t graph = 0;  ///< Graph::id() of the declaration that it belongs to
    friend bool operator==(const ImageHandle&, const ImageHandle&) = default;
};

/// The contents of a buffer at one point of the frame.
struct BufferHandle {
    uint32_t resource = UINT32_MAX;
    uint32_t version = 0;
    uint32_t graph = 0;  ///< Graph::id() of the declaration that it belongs to
    friend bool operator==(const BufferHandle&, const BufferHandle&) = default;
};

/// Contents that live across frames: those of the last frame, and those that this frame makes.
struct ImageHistory {
    ImageHandle previous, current;
};
struct BufferHistory {
    BufferHandle previous, current;
};

/// A 2D image. Every access covers all levels and layers.
struct ImageDescription {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 0;   ///< pixels
    uint32_t height = 0;  ///< pixels
    uint32_t layers = 1;
    uint32_t mip_levels = 1;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    friend bool operator==(const ImageDescription&, const ImageDescription&) = default;
};

struct BufferDescription {
    uint64_t size = 0;  ///< bytes
    friend bool operator==(const BufferDescription&, const BufferDescription&) = default;
};

/// What the world outside of the frame does with an imported resource.
struct ExternalUse {
    Scope scope = {};
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< images: the layout it is in, or is left in
    friend bool operator==(const ExternalUse&, const ExternalUse&) = default;
};

namespace external {
/// Before: nothing to wait for, an image has no contents. After: nobody uses it, an image keeps its last layout.
constexpr ExternalUse none() {
    return {};
}
/// Read by the host after the frame's fence.
constexpr ExternalUse host_read() {
    return {{VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT}, VK_IMAGE_LAYOUT_GENERAL};
}
/// A texture read by fragment or compute shaders.
constexpr ExternalUse sampled() {
    return {{VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT},
            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}
/// The source of a later copy.
constexpr ExternalUse transfer_read() {
    return {{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT}, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
}
/// Handed to the presentation engine; before, wait for the acquire semaphore at COLOR_ATTACHMENT_OUTPUT.
constexpr ExternalUse present() {
    return {{VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0}, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
}
}  // namespace external

struct ImportOptions {
    ExternalUse before = external::none();
    ExternalUse after = external::none();
    /// Someone outside wants what the frame writes to it, so the passes that do are kept. False: scratch space.
    bool wanted = true;
    friend bool operator==(const ImportOptions&, const ImportOptions&) = default;
};

/// What happens to the old contents when a pass writes.
struct Contents {
    ContentsKind kind = ContentsKind::discard;
    VkClearValue value{};

    /// The pass adds to or overwrites parts of what is there; blending needs it (or clear).
    static Contents keep() { return {ContentsKind::keep, {}}; }
    /// The pass overwrites everything that anyone will read.
    static Contents discard() { return {ContentsKind::discard, {}}; }
    /// Attachments only: cleared as the pass begins. The value may change every frame without a new compilation.
    static Contents clear(const VkClearValue& value) { return {ContentsKind::clear, value}; }
};

VkClearValue clear_colour(float red, float green, float blue, float alpha);
VkClearValue clear_depth_stencil(float depth, uint32_t stencil);

using RecordFunction = std::function<void(const PassContext&)>;

/// Declares the accesses of one pass. Valid until the next add_pass() or clear(); afterwards every call throws
/// GraphError.
/// Colour attachments take locations 0, 1, ... and input attachments indices 0, 1, ... in order of declaration.
class Pass {
  public:
    ImageHandle colour_attachment(ImageHandle image, Contents contents);
    /// Tested and written, both aspects.
    ImageHandle depth_stencil_attachment(ImageHandle image, Contents contents);
    /// Tested, never written. The same image may also be an input attachment, or sampled.
    void depth_stencil_read(ImageHandle image);
    void input_attachment(ImageHandle image);

    /// Shader stages default to those of the pass: vertex and fragment, or compute.
    void sampled(ImageHandle image, VkPipelineStageFlags stages = 0);
    void storage_read(ImageHandle image, VkPipelineStageFlags stages = 0);
    void storage_read(BufferHandle buffer, VkPipelineStageFlags stages = 0);
    ImageHandle storage_write(ImageHandle image, Contents contents, VkPipelineStageFlags stages = 0);
    BufferHandle storage_write(BufferHandle buffer, Contents contents, VkPipelineStageFlags stages = 0);
    ImageHandle storage_read_write(ImageHandle image, VkPipelineStageFlags stages = 0);
    BufferHandle storage_read_write(BufferHandle buffer, VkPipelineStageFlags stages = 0);
    void uniform_buffer(BufferHandle buffer, VkPipelineStageFlags stages = 0);
    void vertex_buffer(BufferHandle buffer);
    void index_buffer(BufferHandle buffer);
    void indirect_buffer(BufferHandle buffer);

    void transfer_read(ImageHandle image);
    void transfer_read(BufferHandle buffer);
    ImageHandle transfer_write(ImageHandle image, Contents contents);
    BufferHandle transfer_write(BufferHandle buffer, Contents contents);

    /// The pass does something that the graph cannot see, so it is never culled, and keeps its place among the passes
    /// with side effects.
    void side_effect();
    /// Called once an execution, if the pass was not culled.
    void record(RecordFunction function);

    uint32_t index() const { return index_; }

  private:
    friend class Graph;
    Pass(Graph* graph, uint32_t graph_id, uint32_t index) : graph_(graph), graph_id_(graph_id), index_(index) {}
    ImageHandle add(ImageHandle image, AccessKind kind, Contents contents, VkPipelineStageFlags stages);
    BufferHandle add(BufferHandle buffer, AccessKind kind, Contents contents, VkPipelineStageFlags stages);

    Graph* graph_;
    uint32_t graph_id_;
    uint32_t index_;
};

/// One use of one resource by one pass, as declared.
struct Access {
    uint32_t resource = 0;
    uint32_t version = 0;  ///< of the contents that the pass finds; a write makes version + 1
    AccessKind kind = AccessKind::sampled;
    ContentsKind contents = ContentsKind::keep;
    VkPipelineStageFlags stages = 0;  ///< shader stages, 0 where fixed-function
    friend bool operator==(const Access&, const Access&) = default;
};

static_assert(std::has_unique_object_representations_v<Access>, "compared as bytes");

struct PassDeclaration {
    PassKind kind = PassKind::graphics;
    bool side_effect = false;
    uint32_t first_access = 0;  ///< into Graph::accesses()
    uint32_t access_count = 0;
    friend bool operator==(const PassDeclaration&, const PassDeclaration&) = default;
};

enum class ResourceKind : uint16_t { image, buffer };

/// The two halves of a history are declared one after the other.
enum class HistoryRole : uint8_t {
    none,
    previous,  ///< what `current` held at the end of the frame before; only read
    current,
};

struct ResourceDeclaration {
    ImageDescription image = {};    ///< images
    BufferDescription buffer = {};  ///< buffers
    uint32_t import = UINT32_MAX;   ///< imported resources: into Declaration::imports
    ResourceKind kind = ResourceKind::image;
    bool imported = false;
    HistoryRole history = HistoryRole::none;
    bool transient() const { return !imported && history == HistoryRole::none; }
    friend bool operator==(const ResourceDeclaration&, const ResourceDeclaration&) = default;
};
static_assert(std::has_unique_object_representations_v<ResourceDeclaration>, "compared as bytes");

/// The structure of a frame as plain data. Equal declarations compile to equal plans: names, clear values and record
/// functions do not count.
struct Declaration {
    std::vector<PassDeclaration> passes;
    std::vector<ResourceDeclaration> resources;
    std::vector<Access> accesses;  ///< those of a pass are contiguous
    std::vector<ImportOptions> imports;
    const ImportOptions& import_of(uint32_t resource) const { return imports[resources[resource].import]; }
    friend bool operator==(const Declaration& a, const Declaration& b);
};

class Graph {
  public:
    /// Transient: lives within the frame, has no contents before its first write.
    ImageHandle create_image(std::string_view name, const ImageDescription& description);
    BufferHandle create_buffer(std::string_view name, const BufferDescription& description);
    /// Owned by the caller, who binds the real one at execution. An image has contents if options.before has a layout;
    /// a buffer always has.
    ImageHandle import_image(std::string_view name, const ImageDescription& description, const ImportOptions& options);
    BufferHandle import_buffer(std::string_view name, const BufferDescription& description,
                               const ImportOptions& options);
    /// Contents that live across frames. `previous` holds what the last frame left in `current`; if this frame is the
    /// first, or follows one of another declaration (another size, say), it holds `initial` (buffers: zeros). A frame
    /// that reads `previous` must write `current`, and only `current`.
    ImageHistory create_history_image(std::string_view name, const ImageDescription& description,
                                      const VkClearValue& initial);
    BufferHistory create_history_buffer(std::string_view name, const BufferDescription& description);
    Pass add_pass(std::string_view name, PassKind kind);

    /// Forgets everything, keeps the storage for the next frame's declaration. Handles and passes become invalid.
    void clear();
    /// Tells this declaration from those of other graphs, and from those before clear(): handles and passes carry it.
    /// Drawn at random, so that no state is shared; nothing else depends on it.
    uint32_t id() const { return id_; }
    /// The handle of the contents that the declaration so far leaves in a resource, which must be of that kind.
    ImageHandle image(uint32_t resource) const { return {resource, states_[resource].version, id_}; }
    BufferHandle buffer(uint32_t resource) const { return {resource, states_[resource].version, id_}; }

    const Declaration& declaration() const { return declaration_; }
    /// Of the declaration: equal keys, equal declarations.
    const DeclarationKey& key() const { return key_; }
    std::span<const Access> accesses(uint32_t pass) const {
        const PassDeclaration& declared = declaration_.passes[pass];
        return {declaration_.accesses.data() + declared.first_access, declared.access_count};
    }
    const std::string& pass_name(uint32_t pass) const { return pass_names_[pass]; }
    const std::string& resource_name(uint32_t resource) const { return resource_names_[resource]; }
    const VkClearValue& clear_value(uint32_t access) const { return clear_values_[access]; }
    /// Of a history image.
    const VkClearValue& initial_value(uint32_t resource) const { return initial_values_[resource]; }
    const RecordFunction& record_function(uint32_t pass) const { return functions_[pass]; }

  private:
    friend class Pass;
    static uint32_t random_id();
    struct ResourceState {
        uint32_t version = 0;
        bool has_contents = false;
        uint32_t last_writer = UINT32_MAX;  // pass
        uint32_t last_access = UINT32_MAX;  // index into Declaration::accesses
    };
    uint32_t add_resource(std::string_view name, ResourceDeclaration declaration,
                          const ImportOptions* import = nullptr);
    uint32_t add_history(std::string_view name, ResourceDeclaration declaration, const VkClearValue& initial);
    template <typename Handle>
    Handle add_access(const Pass& pass, const Handle& handle, AccessKind kind, const Contents& contents,
                      VkPipelineStageFlags stages);
    PassDeclaration& open_pass(const Pass& pass);
    void check_access(uint32_t pass, const Access& access) const;
    void check_contents(uint32_t pass, const Access& access) const;
    void check_format(uint32_t pass, const Access& access) const;
    void check_feedback(uint32_t pass, const Access& access) const;
    [[noreturn]] void fail(uint32_t pass, uint32_t resource, const std::string& problem) const;

    uint32_t id_ = random_id();
    Declaration declaration_;
    DeclarationKey key_;
    std::vector<ResourceState> states_;
    std::vector<VkClearValue> clear_values_;    // one an access
    std::vector<VkClearValue> initial_values_;  // one a resource
    std::vector<RecordFunction> functions_;     // one a pass
    std::vector<std::string> pass_names_, resource_names_;
};

/// "image 'depth'", "buffer 'pixels'": for messages.
std::string quote_resource(const Graph& graph, uint32_t resource);

}  // namespace splice::graph
