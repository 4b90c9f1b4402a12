#include "engine/render_graph/export/export.h"

#include "engine/render_graph/export/frame_picture.h"

namespace splice::graph {
namespace {

std::string write(const FramePicture& picture, ExportFormat format) {
    switch (format) {
        case ExportFormat::dot:
            return write_dot(picture);
        case ExportFormat::mermaid:
            return write_mermaid(picture);
        case ExportFormat::json:
            return write_json(picture);
    }
    return "";
}

}  // namespace

std::optional<ExportFormat> export_format_of(std::string_view file_name) {
    if (file_name.ends_with(".dot")) return ExportFormat::dot;
    if (file_name.ends_with(".mmd")) return ExportFormat::mermaid;
    if (file_name.ends_with(".json")) return ExportFormat::json;
    return std::nullopt;
}

std::string export_graph(const Graph& graph, ExportFormat format) {
    return write(picture_of(graph, nullptr), format);
}

std::string export_graph(const Graph& graph, const Plan& plan, ExportFormat format) {
    return write(picture_of(graph, &plan), format);
}

}  // namespace splice::graph
