#include "engine/bench/graph/figures.h"
#include "engine/bench/graph/graph_layout.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace splice::bench {
namespace {

constexpr double kFont = 11, kCellHeight = 24, kPadding = 4, kLayer = 66, kGap = 12, kMargin = 8;

double cell_width(const std::string& name) {
    return std::max(text_width(name, kFont) + 12, 30.0);
}

/// Where things are on the page.
class GraphFigure {
  public:
    explicit GraphFigure(const ExampleGraph& example) : example_(example), boxes_(example.groups) {
        for (const DrawnPass& pass : example.passes) {
            if (pass.culled) continue;
            cell_x_.push_back(boxes_[pass.group].width);
            boxes_[pass.group].width += cell_width(pass.name);
            ++cells_[pass.group];
        }
        for (LayoutBox& box : boxes_)
            box.width += 2 * kPadding;
        for (size_t i = 0; i < example.edges.size(); ++i) {
            const DrawnEdge& edge = example.edges[i];
            const uint32_t from = example.passes[edge.from].group, to = example.passes[edge.to].group;
            if (from == to) continue;
            lines_.push_back({from, to, {}});
            edge_of_line_.push_back(i);
        }
        width_ = lay_out(boxes_, lines_, kGap);
        for (const LayoutBox& box : boxes_)
            layers_ = std::max(layers_, box.layer + 1);
    }

    std::string draw() {
        const double height = static_cast<double>(layers_ - 1) * kLayer + kCellHeight + 2 * kPadding + 2 * kMargin;
        Svg svg(width_ + 2 * kMargin, height, fmt::format("The {} graph", example_.family));
        for (size_t i = 0; i < lines_.size(); ++i)
            draw_line(svg, lines_[i], example_.edges[edge_of_line_[i]]);
        for (size_t group = 0; group < boxes_.size(); ++group) {
            const LayoutBox& box = boxes_[group];
            if (cells_[static_cast<uint32_t>(group)] < 2) continue;
            svg.rectangle(
                left(box), top(box), box.width, kCellHeight + 2 * kPadding, "group",
                fmt::format("group {}: one render pass of {} subpasses", group, cells_[static_cast<uint32_t>(group)]),
                6);
        }
        size_t cell = 0;
        for (const DrawnPass& pass : example_.passes) {
            if (pass.culled) continue;
            const LayoutBox& box = boxes_[pass.group];
            const double x = left(box) + kPadding + cell_x_[cell++], y = top(box) + kPadding;
            svg.rectangle(x + 1.5, y, cell_width(pass.name) - 3, kCellHeight, "cell",
                          fmt::format("{}, group {}", pass.name, pass.group), 4);
            svg.text(x + cell_width(pass.name) / 2, y + kCellHeight / 2 + kFont * 0.36, pass.name, "pass",
                     Anchor::middle);
        }
        return svg.finish();
    }

  private:
    static double left(const LayoutBox& box) { return kMargin + box.x - box.width / 2; }
    static double top(const LayoutBox& box) { return kMargin + static_cast<double>(box.layer) * kLayer; }
    double centre_of(uint32_t pass) const {
        const DrawnPass& drawn = example_.passes[pass];
        return left(boxes_[drawn.group]) + kPadding + cell_x_[pass] + cell_width(drawn.name) / 2;
    }

    /// From the bottom of one cell to the top of the other, upright wherever it meets a layer.
    void draw_line(Svg& svg, const LayoutLine& line, const DrawnEdge& edge) const {
        constexpr double kBox = kCellHeight + 2 * kPadding;
        double x = centre_of(edge.from), y = top(boxes_[line.from]) + kPadding + kCellHeight;
        std::string commands = fmt::format("M{:.1f} {:.1f}", x, y);
        const auto curve_to = [&](double next_x, double next_y) {
            const double middle = (y + next_y) / 2;
            commands +=
                fmt::format(" C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", x, middle, next_x, middle, next_x, next_y);
            x = next_x;
            y = next_y;
        };
        for (size_t i = 0; i < line.x_between.size(); ++i) {
            const double layer_top = kMargin + static_cast<double>(boxes_[line.from].layer + 1 + i) * kLayer;
            curve_to(kMargin + line.x_between[i], layer_top);
            y = layer_top + kBox;
            commands += fmt::format(" L{:.1f} {:.1f}", x, y);
        }
        curve_to(centre_of(edge.to), top(boxes_[line.to]) + kPadding);
        svg.path(
            commands, "edge",
            fmt::format("{}: {} to {}", edge.resource, example_.passes[edge.from].name, example_.passes[edge.to].name));
    }

    const ExampleGraph& example_;
    std::vector<LayoutBox> boxes_;  // one a group
    std::map<uint32_t, uint32_t> cells_;
    std::vector<double> cell_x_;  // of each pass that is kept, within its group
    std::vector<LayoutLine> lines_;
    std::vector<size_t> edge_of_line_;
    double width_ = 0;
    size_t layers_ = 1;
};

}  // namespace

std::string draw_graph(const ExampleGraph& example) {
    return GraphFigure(example).draw();
}

}  // namespace splice::bench
