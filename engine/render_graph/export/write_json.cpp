#include "engine/render_graph/export/frame_picture.h"

#include <nlohmann/json.hpp>

namespace splice::graph {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const FramePicture::Resource& resource, bool compiled) {
    Json json;
    json["name"] = resource.name;
    json["kind"] = resource.is_image ? "image" : "buffer";
    json["residence"] = resource.residence;
    if (resource.is_image) {
        json["format"] = resource.format;
        json["width"] = resource.image.width;
        json["height"] = resource.image.height;
        json["layers"] = resource.image.layers;
        json["mip_levels"] = resource.image.mip_levels;
        json["samples"] = static_cast<uint32_t>(resource.image.samples);
    } else {
        json["bytes"] = resource.bytes;
    }
    const PlannedResource& planned = resource.planned;
    if (!compiled || planned.lifetime.first_group == none) return json;
    json["first_group"] = planned.lifetime.first_group;
    json["last_group"] = planned.lifetime.last_group;
    json["memoryless"] = planned.memoryless;
    if (planned.heap != none) {
        json["heap"] = planned.heap;
        json["offset"] = planned.offset;
        json["size"] = planned.size;
    }
    return json;
}

Json json_of(const FramePicture::Pass& pass, bool compiled) {
    Json json;
    json["name"] = pass.name;
    json["kind"] = describe(pass.kind);
    json["side_effect"] = pass.side_effect;
    json["uses"] = Json::array();
    for (const FramePicture::Use& use : pass.uses) {
        Json used{{"resource", use.resource}, {"version", use.version}, {"how", use.how}};
        if (*use.contents != '\0') used["contents"] = use.contents;
        json["uses"].push_back(std::move(used));
    }
    if (compiled && !pass.culled.empty()) json["culled"] = pass.culled;
    return json;
}

Json json_of(const std::vector<FramePicture::Barrier>& barriers) {
    Json json = Json::array();
    for (const FramePicture::Barrier& barrier : barriers) {
        Json added{{"resource", barrier.resource}, {"after", barrier.source}, {"before", barrier.destination}};
        if (!barrier.new_layout.empty()) {
            added["old_layout"] = barrier.old_layout;
            added["new_layout"] = barrier.new_layout;
        }
        json.push_back(std::move(added));
    }
    return json;
}

Json plan_of(const FramePicture& picture) {
    Json json;
    json["groups"] = Json::array();
    for (const FramePicture::Group& group : picture.groups) {
        Json added;
        added["passes"] = group.passes;
        if (group.width != 0) {
            added["render_pass"] = {
                {"width", group.width}, {"height", group.height}, {"attachments", group.attachments}};
        }
        added["barriers"] = json_of(group.barriers);
        json["groups"].push_back(std::move(added));
    }
    json["final_barriers"] = json_of(picture.final_barriers);
    json["heaps"] = Json::array();
    for (const Heap& heap : picture.heaps)
        json["heaps"].push_back({{"bytes", heap.size}, {"holds", heap.images ? "images" : "buffers"}});
    json["unmerged"] = picture.unmerged;
    return json;
}

}  // namespace

std::string write_json(const FramePicture& picture) {
    Json json;
    json["resources"] = Json::array();
    for (const FramePicture::Resource& resource : picture.resources)
        json["resources"].push_back(json_of(resource, picture.compiled));
    json["passes"] = Json::array();
    for (const FramePicture::Pass& pass : picture.passes)
        json["passes"].push_back(json_of(pass, picture.compiled));
    json["edges"] = Json::array();
    for (const FramePicture::Edge& edge : picture.edges)
        json["edges"].push_back({{"from", edge.from}, {"to", edge.to}, {"resource", edge.resource}});
    if (picture.compiled) json["plan"] = plan_of(picture);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace splice::graph
