#include "engine/render_graph/export/frame_picture.h"

namespace splice::graph {
namespace {

/// As a quoted string of Mermaid, which knows the entities of HTML and no other escape.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char character : text) {
        switch (character) {
            case '"':
                result += "#quot;";
                break;
            case '#':
                result += "#35;";
                break;
            case '<':
                result += "#lt;";
                break;
            case '>':
                result += "#gt;";
                break;
            case '\n':
                result += ' ';
                break;
            default:
                result += character;
        }
    }
    return result + '"';
}

std::string node(uint32_t pass) {
    return "pass" + std::to_string(pass);
}

std::string declare(const FramePicture& picture, uint32_t index) {
    const FramePicture::Pass& pass = picture.passes[index];
    return node(index) + "[" + quoted(pass.name) + "]:::" + (pass.culled.empty() ? describe(pass.kind) : "culled") +
           "\n";
}

}  // namespace

std::string write_mermaid(const FramePicture& picture) {
    std::string text = "flowchart LR\n";
    for (uint32_t group = 0; group < picture.groups.size(); ++group) {
        const std::vector<std::string> label = group_label(picture, group);
        text += "  subgraph group" + std::to_string(group) + "[" + quoted(label[0] + "; " + label[1]) + "]\n";
        for (const uint32_t pass : picture.groups[group].passes)
            text += "    " + declare(picture, pass);
        text += "  end\n";
    }
    for (uint32_t pass = 0; pass < picture.passes.size(); ++pass) {
        if (!picture.compiled || !picture.passes[pass].culled.empty()) text += "  " + declare(picture, pass);
    }
    for (const FramePicture::Edge& edge : picture.edges) {
        text += "  " + node(edge.from) + (edge.inside ? " -.->|" : " -->|") +
                quoted(picture.resources[edge.resource].name) + "| " + node(edge.to) + "\n";
    }
    return text +
           "  classDef graphics fill:#add8e6,color:#000\n"
           "  classDef compute fill:#98fb98,color:#000\n"
           "  classDef transfer fill:#f0e68c,color:#000\n"
           "  classDef culled fill:#bebebe,color:#000,stroke-dasharray:4\n";
}

}  // namespace splice::graph
