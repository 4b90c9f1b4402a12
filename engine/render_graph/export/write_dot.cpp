#include "engine/render_graph/export/frame_picture.h"

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

const char* colour_of(const FramePicture::Pass& pass) {
    if (!pass.culled.empty()) return "grey";
    switch (pass.kind) {
        case PassKind::graphics:
            return "lightblue";
        case PassKind::compute:
            return "palegreen";
        case PassKind::transfer:
            return "khaki";
    }
    return "white";
}

std::string declare(const FramePicture& picture, uint32_t index) {
    const FramePicture::Pass& pass = picture.passes[index];
    std::string line = node(index) + " [label=" + quoted(pass.name) + ", fillcolor=" + colour_of(pass);
    if (!pass.culled.empty()) line += ", tooltip=" + quoted(pass.culled);
    return line + "];\n";
}

}  // namespace

std::string write_dot(const FramePicture& picture) {
    std::string dot = "digraph frame {\n  rankdir=LR;\n  node [shape=box, style=filled];\n";
    for (uint32_t group = 0; group < picture.groups.size(); ++group) {
        const std::vector<std::string> label = group_label(picture, group);
        dot += "  subgraph cluster" + std::to_string(group) + " {\n    label=" + quoted(label[0] + "\n" + label[1]) +
               ";\n";
        for (const uint32_t pass : picture.groups[group].passes)
            dot += "    " + declare(picture, pass);
        dot += "  }\n";
    }
    for (uint32_t pass = 0; pass < picture.passes.size(); ++pass) {
        if (!picture.compiled || !picture.passes[pass].culled.empty()) dot += "  " + declare(picture, pass);
    }
    for (const FramePicture::Edge& edge : picture.edges) {
        dot += "  " + node(edge.from) + " -> " + node(edge.to) +
               " [label=" + quoted(picture.resources[edge.resource].name) +
               (edge.inside ? ", style=dashed];\n" : "];\n");
    }
    return dot + "}\n";
}

}  // namespace splice::graph
