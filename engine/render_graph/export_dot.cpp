#include "engine/render_graph/export_dot.h"

#include "engine/render_graph/compile.h"

#include <vector>

namespace splice::graph {
namespace {

/// As a quoted string of the DOT language.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') result += '\\';
        if (character == '\n') {
            result += "\\n";
        } else {
            result += character;
        }
    }
    return result + '"';
}

std::string node(uint32_t pass) {
    return "pass" + std::to_string(pass);
}

const char* colour_of(PassKind kind) {
    switch (kind) {
        case PassKind::graphics:
            return "lightblue";
        case PassKind::compute:
            return "palegreen";
        case PassKind::transfer:
            return "khaki";
    }
    return "white";
}

std::string group_label(const Plan& plan, uint32_t index) {
    const Group& group = plan.groups[index];
    std::string label = std::to_string(index);
    if (group.render_pass != none) {
        const RenderPass& render_pass = plan.render_passes[group.render_pass];
        label += ": render pass " + std::to_string(render_pass.width) + " x " + std::to_string(render_pass.height) +
                 ", " + std::to_string(render_pass.attachments.count) + " attachments";
    }
    const uint32_t barriers = group.barriers.images.count + group.barriers.buffers.count;
    return label + "\n" + std::to_string(barriers) + (barriers == 1 ? " barrier" : " barriers") + " before";
}

}  // namespace

std::string to_dot(const Graph& graph, const Plan& plan) {
    const Declaration& declaration = graph.declaration();
    std::vector<uint32_t> group_of(declaration.passes.size(), none);
    std::string dot = "digraph frame {\n  rankdir=LR;\n  node [shape=box, style=filled];\n";
    for (uint32_t index = 0; index < plan.groups.size(); ++index) {
        dot +=
            "  subgraph cluster" + std::to_string(index) + " {\n    label=" + quoted(group_label(plan, index)) + ";\n";
        for (const uint32_t pass : slice(plan.order, plan.groups[index].passes)) {
            group_of[pass] = index;
            dot += "    " + node(pass) + " [label=" + quoted(graph.pass_name(pass)) +
                   ", fillcolor=" + colour_of(declaration.passes[pass].kind) + "];\n";
        }
        dot += "  }\n";
    }
    for (const CulledPass& culled : plan.culled) {
        dot += "  " + node(culled.pass) + " [label=" + quoted(graph.pass_name(culled.pass)) +
               ", fillcolor=grey, tooltip=" + quoted(explain(graph, culled)) + "];\n";
    }
    std::vector<uint32_t> maker(declaration.resources.size(), none);
    for (uint32_t pass = 0; pass < declaration.passes.size(); ++pass) {
        for (const Access& access : graph.accesses(pass)) {
            const uint32_t from = maker[access.resource];
            const bool reads = !is_write(access.kind) || access.contents == ContentsKind::keep;
            if (reads && from != none) {
                const bool inside = group_of[from] != none && group_of[from] == group_of[pass];
                dot += "  " + node(from) + " -> " + node(pass) +
                       " [label=" + quoted(graph.resource_name(access.resource)) +
                       (inside ? ", style=dashed];\n" : "];\n");
            }
            if (is_write(access.kind)) maker[access.resource] = pass;
        }
    }
    return dot + "}\n";
}

}  // namespace splice::graph
