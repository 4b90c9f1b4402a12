#include "engine/render_graph/graph.h"

#include <cstring>
#include <random>
#include <type_traits>

namespace splice::graph {
namespace {

constexpr VkPipelineStageFlags kGraphicsShaders =
    VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags kComputeShader = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;

bool allowed(AccessKind kind, PassKind pass) {
    switch (kind) {
        case AccessKind::colour_attachment:
        case AccessKind::depth_stencil_attachment:
        case AccessKind::depth_stencil_read:
        case AccessKind::input_attachment:
        case AccessKind::vertex:
        case AccessKind::index:
            return pass == PassKind::graphics;
        case AccessKind::transfer_read:
        case AccessKind::transfer_write:
            return pass == PassKind::transfer;
        default:
            return pass != PassKind::transfer;
    }
}

/// The kinds of passes that may use a resource so: "a graphics pass".
std::string allowed_passes(AccessKind kind) {
    std::string text;
    for (const PassKind pass : {PassKind::graphics, PassKind::compute, PassKind::transfer}) {
        if (allowed(kind, pass)) text += (text.empty() ? "a " : " or a ") + std::string(describe(pass)) + " pass";
    }
    return text;
}

VkPipelineStageFlags shaders_of(PassKind kind) {
    return kind == PassKind::compute
               ? VkPipelineStageFlags{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT}
               : VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_TESSELLATION_CONTROL_SHADER_BIT |
                     VK_PIPELINE_STAGE_TESSELLATION_EVALUATION_SHADER_BIT | VK_PIPELINE_STAGE_GEOMETRY_SHADER_BIT |
                     VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
}

}  // namespace

VkClearValue clear_colour(float red, float green, float blue, float alpha) {
    VkClearValue value;
    value.color = {.float32 = {red, green, blue, alpha}};
    return value;
}

VkClearValue clear_depth_stencil(float depth, uint32_t stencil) {
    VkClearValue value;
    value.depthStencil = {depth, stencil};
    return value;
}

std::string quote_resource(const Graph& graph, uint32_t resource) {
    const bool image = graph.declaration().resources[resource].kind == ResourceKind::image;
    return (image ? "image '" : "buffer '") + graph.resource_name(resource) + "'";
}

bool operator==(const Declaration& a, const Declaration& b) {
    const auto same_bytes = []<typename T>(const std::vector<T>& x, const std::vector<T>& y) {
        return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(T)) == 0);
    };
    return same_bytes(a.accesses, b.accesses) && same_bytes(a.resources, b.resources) && a.passes == b.passes &&
           a.imports == b.imports;
}

uint32_t Graph::add_resource(std::string_view name, ResourceDeclaration declaration, const ImportOptions* import) {
    const ImageDescription& image = declaration.image;
    if (declaration.kind == ResourceKind::image && (image.format == VK_FORMAT_UNDEFINED || image.width == 0 ||
                                                    image.height == 0 || image.layers == 0 || image.mip_levels == 0)) {
        throw GraphError("image '" + std::string(name) + "': needs a format, and at least 1 pixel, layer and level");
    }
    if (declaration.kind == ResourceKind::buffer && declaration.buffer.size == 0) {
        throw GraphError("buffer '" + std::string(name) + "': needs at least 1 byte");
    }
    ResourceState state;
    if (import) {
        declaration.imported = true;
        declaration.import = static_cast<uint32_t>(declaration_.imports.size());
        declaration_.imports.push_back(*import);
        state.has_contents =
            declaration.kind == ResourceKind::buffer || import->before.layout != VK_IMAGE_LAYOUT_UNDEFINED;
    }
    const auto index = static_cast<uint32_t>(declaration_.resources.size());
    declaration_.resources.push_back(declaration);
    key_.resources.add_bytes(declaration);
    if (import) {
        for (const ExternalUse& use : {import->before, import->after}) {
            key_.resources.add(use.scope.stages);
            key_.resources.add(use.scope.access);
            key_.resources.add(static_cast<uint64_t>(use.layout));
        }
        key_.resources.add(import->wanted ? 1 : 0);
    }
    resource_names_.emplace_back(name);
    initial_values_.emplace_back();
    states_.push_back(state);
    return index;
}

/// Adds both halves and returns the first.
uint32_t Graph::add_history(std::string_view name, ResourceDeclaration declaration, const VkClearValue& initial) {
    declaration.history = HistoryRole::previous;
    const uint32_t previous = add_resource(std::string(name) + " of the last frame", declaration);
    states_[previous].has_contents = true;
    initial_values_[previous] = initial;
    declaration.history = HistoryRole::current;
    add_resource(name, declaration);
    return previous;
}

ImageHandle Graph::create_image(std::string_view name, const ImageDescription& description) {
    return {add_resource(name, {.image = description}), 0, id_};
}

BufferHandle Graph::create_buffer(std::string_view name, const BufferDescription& description) {
    return {add_resource(name, {.buffer = description, .kind = ResourceKind::buffer}), 0, id_};
}

ImageHandle Graph::import_image(std::string_view name, const ImageDescription& description,
                                const ImportOptions& options) {
    return {add_resource(name, {.image = description}, &options), 0, id_};
}

BufferHandle Graph::import_buffer(std::string_view name, const BufferDescription& description,
                                  const ImportOptions& options) {
    return {add_resource(name, {.buffer = description, .kind = ResourceKind::buffer}, &options), 0, id_};
}

ImageHistory Graph::create_history_image(std::string_view name, const ImageDescription& description,
                                         const VkClearValue& initial) {
    const uint32_t previous = add_history(name, {.image = description}, initial);
    return {{previous, 0, id_}, {previous + 1, 0, id_}};
}

BufferHistory Graph::create_history_buffer(std::string_view name, const BufferDescription& description) {
    const uint32_t previous = add_history(name, {.buffer = description, .kind = ResourceKind::buffer}, {});
    return {{previous, 0, id_}, {previous + 1, 0, id_}};
}

Pass Graph::add_pass(std::string_view name, PassKind kind) {
    PassDeclaration pass;
    pass.kind = kind;
    pass.first_access = static_cast<uint32_t>(declaration_.accesses.size());
    declaration_.passes.push_back(pass);
    key_.passes.add(uint64_t{pass.first_access} << 8 | static_cast<uint64_t>(kind));
    pass_names_.emplace_back(name);
    functions_.emplace_back();
    return {this, id_, static_cast<uint32_t>(declaration_.passes.size() - 1)};
}

uint32_t Graph::random_id() {
    return std::random_device{}();
}

void Graph::clear() {
    ++id_;
    declaration_.passes.clear();
    declaration_.resources.clear();
    declaration_.accesses.clear();
    declaration_.imports.clear();
    key_ = {};
    states_.clear();
    clear_values_.clear();
    initial_values_.clear();
    functions_.clear();
    pass_names_.clear();
    resource_names_.clear();
}

void Graph::fail(uint32_t pass, uint32_t resource, const std::string& problem) const {
    throw GraphError("pass '" + pass_names_[pass] + "', " + quote_resource(*this, resource) + ": " + problem);
}

PassDeclaration& Graph::open_pass(const Pass& pass) {
    if (pass.graph_id_ != id_) {
        throw GraphError("pass " + std::to_string(pass.index_) +
                         ": belongs to a declaration that was cleared; add it anew after clear()");
    }
    if (pass.index_ + 1 != declaration_.passes.size()) {
        throw GraphError("pass '" + pass_names_[pass.index_] +
                         "': is complete since the next pass was added; declare all of it before");
    }
    return declaration_.passes.back();
}

template <typename Handle>
Handle Graph::add_access(const Pass& open, const Handle& handle, AccessKind kind, const Contents& contents,
                         VkPipelineStageFlags stages) {
    constexpr bool image = std::is_same_v<Handle, ImageHandle>;
    PassDeclaration& declared = open_pass(open);
    const uint32_t pass = open.index_, resource = handle.resource;
    if (handle.graph != id_ || resource >= declaration_.resources.size() ||
        declaration_.resources[resource].kind != (image ? ResourceKind::image : ResourceKind::buffer)) {
        throw GraphError("pass '" + pass_names_[pass] + "': uses a handle that no " + (image ? "image" : "buffer") +
                         " of this graph has; use one that this graph gave out since it was last cleared");
    }
    Access access{resource, handle.version, kind, is_write(kind) ? contents.kind : ContentsKind::keep, 0};
    if (traits_of(kind).shader) {
        const VkPipelineStageFlags own = declared.kind == PassKind::compute ? kComputeShader : kGraphicsShaders;
        access.stages = stages == 0 ? own : stages;
    }
    check_access(pass, access);
    const auto index = static_cast<uint32_t>(declaration_.accesses.size());
    declaration_.accesses.push_back(access);
    key_.accesses.add_bytes(access);
    clear_values_.push_back(contents.value);
    ++declared.access_count;
    ResourceState& state = states_[resource];
    state.last_access = index;
    if (is_write(kind)) {
        ++state.version;
        state.has_contents = true;
        state.last_writer = pass;
    }
    return {resource, state.version, id_};
}

void Graph::check_access(uint32_t pass, const Access& access) const {
    const PassDeclaration& declared = declaration_.passes[pass];
    if (!allowed(access.kind, declared.kind)) {
        fail(pass, access.resource,
             std::string("a ") + describe(declared.kind) + " pass cannot use " + describe(access.kind) +
                 "; use it in " + allowed_passes(access.kind));
    }
    if ((access.stages & ~shaders_of(declared.kind)) != 0) {
        fail(
            pass, access.resource,
            std::string("names shader stages that a ") + describe(declared.kind) + " pass does not have; name its own");
    }
    if (is_write(access.kind) && declaration_.resources[access.resource].history == HistoryRole::previous) {
        fail(pass, access.resource, "is only read; write the current half of the history");
    }
    check_feedback(pass, access);
    const ResourceState& state = states_[access.resource];
    if (access.version != state.version) {
        if (access.version > state.version) {
            fail(pass, access.resource, "no pass has written these contents yet; add the writing pass before");
        }
        fail(pass, access.resource,
             "stale handle: pass '" + pass_names_[state.last_writer] +
                 "' has written it; use the handle that the last write returned");
    }
    check_contents(pass, access);
    check_format(pass, access);
}

void Graph::check_contents(uint32_t pass, const Access& access) const {
    if (access.contents == ContentsKind::clear && !is_attachment(access.kind)) {
        fail(pass, access.resource, "only attachments can be cleared; clear it in a pass before and keep the contents");
    }
    const bool reads = !is_write(access.kind) || access.contents == ContentsKind::keep;
    if (reads && !states_[access.resource].has_contents) {
        fail(pass, access.resource,
             is_write(access.kind) ? "keeps contents that nobody has written; clear or discard them"
                                   : "is read before anything has written it; add the writing pass before");
    }
}

void Graph::check_format(uint32_t pass, const Access& access) const {
    const ResourceDeclaration& resource = declaration_.resources[access.resource];
    if (resource.kind != ResourceKind::image) return;
    const bool depth = is_depth_stencil(resource.image.format);
    const bool wants_depth =
        access.kind == AccessKind::depth_stencil_attachment || access.kind == AccessKind::depth_stencil_read;
    const bool wants_colour = access.kind == AccessKind::colour_attachment ||
                              (traits_of(access.kind).image_usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0;
    if ((wants_depth && !depth) || (wants_colour && depth)) {
        fail(pass, access.resource,
             std::string("its format cannot be ") + describe(access.kind) +
                 (depth ? ", as it has depth or stencil; create it with a colour format"
                        : ", as it has no depth or stencil; create it with a format that has"));
    }
}

void Graph::check_feedback(uint32_t pass, const Access& access) const {
    const ResourceState& state = states_[access.resource];
    const PassDeclaration& declared = declaration_.passes[pass];
    const bool used = state.last_access != UINT32_MAX && state.last_access >= declared.first_access;
    if (used) {
        // One earlier use stands for all: either it is the only one, or they are reads of one layout.
        const Access& earlier = declaration_.accesses[state.last_access];
        const VkFormat format = declaration_.resources[access.resource].image.format;
        if (is_write(earlier.kind) || is_write(access.kind)) {
            fail(pass, access.resource,
                 std::string("feedback loop: it is ") + describe(earlier.kind) + " and " + describe(access.kind) +
                     " in the same pass; use a second pass or a second resource");
        }
        if (layout_of(earlier.kind, format) != layout_of(access.kind, format)) {
            fail(pass, access.resource,
                 std::string("is ") + describe(earlier.kind) + " and " + describe(access.kind) +
                     " in the same pass, which need different layouts; read it in one way");
        }
    }
    if (access.kind == AccessKind::depth_stencil_attachment || access.kind == AccessKind::depth_stencil_read) {
        for (const Access& other : accesses(pass)) {
            if (other.kind == AccessKind::depth_stencil_attachment || other.kind == AccessKind::depth_stencil_read) {
                fail(pass, access.resource,
                     "a pass has one depth-stencil attachment at most, and it has " +
                         quote_resource(*this, other.resource) + "; split the pass");
            }
        }
    }
}

ImageHandle Pass::add(ImageHandle image, AccessKind kind, Contents contents, VkPipelineStageFlags stages) {
    return graph_->add_access(*this, image, kind, contents, stages);
}

BufferHandle Pass::add(BufferHandle buffer, AccessKind kind, Contents contents, VkPipelineStageFlags stages) {
    return graph_->add_access(*this, buffer, kind, contents, stages);
}

ImageHandle Pass::colour_attachment(ImageHandle image, Contents contents) {
    return add(image, AccessKind::colour_attachment, contents, 0);
}
ImageHandle Pass::depth_stencil_attachment(ImageHandle image, Contents contents) {
    return add(image, AccessKind::depth_stencil_attachment, contents, 0);
}
void Pass::depth_stencil_read(ImageHandle image) {
    add(image, AccessKind::depth_stencil_read, Contents::keep(), 0);
}
void Pass::input_attachment(ImageHandle image) {
    add(image, AccessKind::input_attachment, Contents::keep(), 0);
}

void Pass::sampled(ImageHandle image, VkPipelineStageFlags stages) {
    add(image, AccessKind::sampled, Contents::keep(), stages);
}
void Pass::storage_read(ImageHandle image, VkPipelineStageFlags stages) {
    add(image, AccessKind::storage_read, Contents::keep(), stages);
}
void Pass::storage_read(BufferHandle buffer, VkPipelineStageFlags stages) {
    add(buffer, AccessKind::storage_read, Contents::keep(), stages);
}
ImageHandle Pass::storage_write(ImageHandle image, Contents contents, VkPipelineStageFlags stages) {
    return add(image, AccessKind::storage_write, contents, stages);
}
BufferHandle Pass::storage_write(BufferHandle buffer, Contents contents, VkPipelineStageFlags stages) {
    return add(buffer, AccessKind::storage_write, contents, stages);
}
ImageHandle Pass::storage_read_write(ImageHandle image, VkPipelineStageFlags stages) {
    return add(image, AccessKind::storage_read_write, Contents::keep(), stages);
}
BufferHandle Pass::storage_read_write(BufferHandle buffer, VkPipelineStageFlags stages) {
    return add(buffer, AccessKind::storage_read_write, Contents::keep(), stages);
}
void Pass::uniform_buffer(BufferHandle buffer, VkPipelineStageFlags stages) {
    add(buffer, AccessKind::uniform, Contents::keep(), stages);
}
void Pass::vertex_buffer(BufferHandle buffer) {
    add(buffer, AccessKind::vertex, Contents::keep(), 0);
}
void Pass::index_buffer(BufferHandle buffer) {
    add(buffer, AccessKind::index, Contents::keep(), 0);
}
void Pass::indirect_buffer(BufferHandle buffer) {
    add(buffer, AccessKind::indirect, Contents::keep(), 0);
}

void Pass::transfer_read(ImageHandle image) {
    add(image, AccessKind::transfer_read, Contents::keep(), 0);
}
void Pass::transfer_read(BufferHandle buffer) {
    add(buffer, AccessKind::transfer_read, Contents::keep(), 0);
}
ImageHandle Pass::transfer_write(ImageHandle image, Contents contents) {
    return add(image, AccessKind::transfer_write, contents, 0);
}
BufferHandle Pass::transfer_write(BufferHandle buffer, Contents contents) {
    return add(buffer, AccessKind::transfer_write, contents, 0);
}

void Pass::side_effect() {
    PassDeclaration& pass = graph_->open_pass(*this);
    if (!pass.side_effect) graph_->key_.side_effects.add(index_);
    pass.side_effect = true;
}

void Pass::record(RecordFunction function) {
    graph_->open_pass(*this);
    graph_->functions_[index_] = std::move(function);
}

}  // namespace splice::graph
