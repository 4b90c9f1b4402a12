#include "engine/bench/report/svg.h"

#include <fmt/format.h>

namespace splice::bench {

std::string escape_markup(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

Svg::Svg(double width, double height, std::string_view label)
    : text_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
                        "height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n",
                        width, height, escape_markup(label))) {}

void Svg::close(std::string_view element, std::string_view title) {
    if (title.empty()) {
        text_ += "/>\n";
    } else {
        text_ += fmt::format("><title>{}</title></{}>\n", escape_markup(title), element);
    }
}

void Svg::rectangle(double x, double y, double width, double height, std::string_view style, std::string_view title,
                    double radius) {
    text_ +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"{:.0f}\" class=\"{}\"", x,
                    y, width, height, radius, style);
    close("rect", title);
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view style) {
    text_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", x1, y1, x2,
                         y2, style);
}

void Svg::path(std::string_view commands, std::string_view style, std::string_view title) {
    text_ += fmt::format("<path d=\"{}\" class=\"{}\"", commands, style);
    close("path", title);
}

void Svg::circle(double x, double y, double radius, std::string_view style, std::string_view title) {
    text_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" class=\"{}\"", x, y, radius, style);
    close("circle", title);
}

void Svg::text(double x, double y, std::string_view text, std::string_view style, Anchor anchor, double degrees) {
    static constexpr const char* kAnchors[] = {"start", "middle", "end"};
    text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" class=\"{}\"", x, y,
                         kAnchors[static_cast<int>(anchor)], style);
    if (degrees != 0) text_ += fmt::format(" transform=\"rotate({:.0f} {:.1f} {:.1f})\"", degrees, x, y);
    text_ += fmt::format(">{}</text>\n", escape_markup(text));
}

std::string Svg::finish() const {
    return text_ + "</svg>\n";
}

double text_width(std::string_view text, double font_px) {
    return 0.6 * font_px * static_cast<double>(text.size());
}

}  // namespace splice::bench
