// What all formats of export.h show, gathered in one walk over declaration and plan.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>
#include <string>
#include <vector>

namespace splice::graph {

struct FramePicture {
    struct Resource {
        std::string name;
        const char* residence = "";  // transient, imported, history
        std::string format;          // images
        ImageDescription image;      // images
        uint64_t bytes = 0;          // declared of buffers
        bool is_image = true;
        PlannedResource planned;  // as compiled
    };
    struct Use {
        uint32_t resource = 0, version = 0;
        const char* how = "";
        const char* contents = "";  // of writes: keep, discard, clear
    };
    struct Pass {
        std::string name;
        PassKind kind = PassKind::graphics;
        bool side_effect = false;
        std::string culled;  // the reason, as a sentence; empty: recorded
        std::vector<Use> uses;
    };
    struct Barrier {
        uint32_t resource = 0;
        std::string source, destination;     // stages and accesses
        std::string old_layout, new_layout;  // images
    };
    /// Passes recorded together. In a declaration, which has no order yet, each pass alone.
    struct Group {
        std::vector<uint32_t> passes;
        uint32_t width = 0, height = 0, attachments = 0;  // of render passes
        std::vector<Barrier> barriers;                    // before the group
    };
    /// `to` finds the resource as `from` left it.
    struct Edge {
        uint32_t from = 0, to = 0, resource = 0;
        bool inside = false;  // a render pass
    };
    bool compiled = false;
    std::vector<Resource> resources;
    std::vector<Pass> passes;
    std::vector<Group> groups;
    std::vector<Edge> edges;
    std::vector<Barrier> final_barriers;
    std::vector<Heap> heaps;
    std::vector<std::string> unmerged;  // the reasons, as sentences
};

/// `plan` may be null.
FramePicture picture_of(const Graph& graph, const Plan* plan);

/// "3: render pass 640 x 480, 4 attachments", "2 barriers before"
std::vector<std::string> group_label(const FramePicture& picture, uint32_t group);

std::string write_dot(const FramePicture& picture);
std::string write_mermaid(const FramePicture& picture);
std::string write_json(const FramePicture& picture);

}  // namespace splice::graph
