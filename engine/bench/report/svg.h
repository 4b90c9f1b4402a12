// A drawing as SVG text. Colours and fonts come from the classes that the page styles (report_html.cpp), so that one
// drawing suits light and dark pages.
#pragma once

#include <string>
#include <string_view>

namespace splice::bench {

/// The text with &, <, > and quotes replaced.
std::string escape_markup(std::string_view text);

enum class Anchor { start, middle, end };

class Svg {
  public:
    /// `label` is read out to those who cannot see the drawing. Shrinks to the width of the page, never grows.
    Svg(double width, double height, std::string_view label);

    /// `title` shows while the pointer rests on it.
    void rectangle(double x, double y, double width, double height, std::string_view style, std::string_view title = {},
                   double radius = 0);
    void line(double x1, double y1, double x2, double y2, std::string_view style);
    void path(std::string_view commands, std::string_view style, std::string_view title = {});
    void circle(double x, double y, double radius, std::string_view style, std::string_view title = {});
    void text(double x, double y, std::string_view text, std::string_view style, Anchor anchor = Anchor::start,
              double degrees = 0);
    std::string finish() const;

  private:
    void close(std::string_view element, std::string_view title);
    std::string text_;
};

/// Width of a text in the page's font, pixels; an estimate that errs on the large side.
double text_width(std::string_view text, double font_px);

}  // namespace splice::bench
