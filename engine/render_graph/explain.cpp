// The reasons in a plan as sentences.
#include "engine/render_graph/compile.h"

namespace splice::graph {
namespace {

std::string quote_pass(const Graph& graph, uint32_t pass) {
    return "pass '" + graph.pass_name(pass) + "'";
}

}  // namespace

std::string explain(const Graph& graph, const CulledPass& culled) {
    std::string text = quote_pass(graph, culled.pass) + " is culled: ";
    switch (culled.reason) {
        case CullReason::writes_nothing:
            return text + "it writes nothing and has no side effect";
        case CullReason::never_read:
            return text + "nothing reads " + quote_resource(graph, culled.resource);
        case CullReason::overwritten:
            return text + quote_pass(graph, culled.other) + " overwrites " + quote_resource(graph, culled.resource) +
                   " before anything reads it";
        case CullReason::readers_culled:
            return text + "what reads " + quote_resource(graph, culled.resource) + " is culled, " +
                   quote_pass(graph, culled.other) + " for one";
    }
    return text;
}

std::string explain(const Graph& graph, const Unmerged& unmerged) {
    std::string text =
        quote_pass(graph, unmerged.later) + " is not merged with " + quote_pass(graph, unmerged.earlier) + ": ";
    switch (unmerged.reason) {
        case UnmergedReason::not_pixel_local:
            return text + quote_resource(graph, unmerged.resource) + " is not used as an attachment by all of them";
        case UnmergedReason::different_size:
            return text + "they render to areas of different size";
        case UnmergedReason::different_samples:
            return text + "they have different numbers of samples";
        case UnmergedReason::clears_attachment:
            return text + "it clears " + quote_resource(graph, unmerged.resource) + ", which is in use before";
        case UnmergedReason::different_layouts:
            return text + "they read " + quote_resource(graph, unmerged.resource) + " in different layouts";
        case UnmergedReason::pass_between:
            return text + quote_pass(graph, unmerged.other) + " depends on a pass of the group and must run before it";
        case UnmergedReason::gave_up:
            return text + "whether " + quote_pass(graph, unmerged.other) +
                   " must run between them was not found out in time";
        case UnmergedReason::switched_off:
            return text + "merging is switched off";
    }
    return text;
}

}  // namespace splice::graph
