// What can only be judged once a pass is complete: its attachments against each other and against the device's limits.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>
#include <string>

namespace splice::graph {
namespace {

[[noreturn]] void fail(const Compilation& compilation, uint32_t pass, uint32_t resource, const std::string& problem) {
    throw GraphError("pass '" + compilation.graph.pass_name(pass) + "', " +
                     quote_resource(compilation.graph, resource) + ": " + problem);
}

std::string size_text(const ImageDescription& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height) + " x " + std::to_string(image.layers);
}

void validate_graphics_pass(const Compilation& compilation, uint32_t pass) {
    const ResourceDeclaration* first = nullptr;
    uint32_t first_resource = none, colours = 0, inputs = 0;
    const ImageDescription* sampled_target = nullptr;
    for (const Access& access : compilation.graph.accesses(pass)) {
        if (!is_attachment(access.kind)) continue;
        const ResourceDeclaration& resource = compilation.declaration.resources[access.resource];
        if (!first) {
            first = &resource;
            first_resource = access.resource;
        } else if (resource.image.width != first->image.width || resource.image.height != first->image.height ||
                   resource.image.layers != first->image.layers) {
            fail(compilation, pass, access.resource,
                 "is " + size_text(resource.image) + ", but " + quote_resource(compilation.graph, first_resource) +
                     " is " + size_text(first->image) +
                     "; the attachments of a pass have one size (sample an image of another size)");
        }
        if (resource.image.mip_levels != 1) {
            fail(compilation, pass, access.resource, "an attachment has one level; render to an image without levels");
        }
        if (access.kind != AccessKind::input_attachment) {
            if (sampled_target && sampled_target->samples != resource.image.samples) {
                fail(compilation, pass, access.resource,
                     "has another number of samples than the other attachments of the pass; give all the same");
            }
            sampled_target = &resource.image;
        }
        const bool colour = access.kind == AccessKind::colour_attachment;
        if (colour && ++colours > compilation.options.max_colour_attachments) {
            fail(compilation, pass, access.resource,
                 "too many colour attachments: the device allows " +
                     std::to_string(compilation.options.max_colour_attachments) + "; split the pass");
        }
        if (access.kind == AccessKind::input_attachment && ++inputs > compilation.options.max_input_attachments) {
            fail(compilation, pass, access.resource,
                 "too many input attachments: the device allows " +
                     std::to_string(compilation.options.max_input_attachments) + "; sample the image instead");
        }
    }
    if (!first) {
        throw GraphError(
            "pass '" + compilation.graph.pass_name(pass) +
            "': a graphics pass needs an attachment, which sets the area it renders to; give it one or make it a "
            "compute pass");
    }
}

/// The frame makes what the next one reads.
void validate_histories(const Compilation& compilation) {
    const Declaration& declaration = compilation.declaration;
    std::vector<uint8_t> written(declaration.resources.size(), 0);
    for (const Access& access : declaration.accesses)
        written[access.resource] = written[access.resource] || is_write(access.kind);
    for (uint32_t pass = 0; pass < declaration.passes.size(); ++pass) {
        for (const Access& access : compilation.graph.accesses(pass)) {
            if (declaration.resources[access.resource].history != HistoryRole::previous) continue;
            if (written[access.resource + 1]) continue;
            fail(compilation, pass, access.resource,
                 "is read, but no pass writes what the next frame will read; write " +
                     quote_resource(compilation.graph, access.resource + 1));
        }
    }
}

}  // namespace

void validate(Compilation& compilation) {
    for (uint32_t pass = 0; pass < compilation.declaration.passes.size(); ++pass) {
        if (compilation.declaration.passes[pass].kind == PassKind::graphics) validate_graphics_pass(compilation, pass);
    }
    const std::vector<ResourceDeclaration>& resources = compilation.declaration.resources;
    if (std::any_of(resources.begin(), resources.end(),
                    [](const ResourceDeclaration& resource) { return resource.history != HistoryRole::none; })) {
        validate_histories(compilation);
    }
}

}  // namespace splice::graph
