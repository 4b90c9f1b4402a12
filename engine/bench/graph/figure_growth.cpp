#include "engine/bench/graph/figures.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace splice::bench {
namespace {

constexpr double kWidth = 1040, kHeight = 420, kLeft = 76, kRight = 160, kTop = 14, kBottom = 50;
constexpr double kLabelGap = 15;  // between the names at the ends of the lines

/// One logarithmic axis: values from `low` to `high` onto pixels from `begin` to `end`.
struct Axis {
    double low, high, begin, end;
    double at(double value) const {
        return begin + (std::log(value) - std::log(low)) / (std::log(high) - std::log(low)) * (end - begin);
    }
};

struct Curve {
    std::string family;
    std::vector<std::pair<double, double>> points;  // passes, ns a pass
};

std::vector<Curve> curves_of(const GraphReport& report) {
    std::vector<Curve> curves;
    for (const CompileResult& result : report.compiled) {
        if (curves.empty() || curves.back().family != result.family) curves.push_back({result.family, {}});
        curves.back().points.emplace_back(result.passes, result.compile_ns.median / result.passes);
    }
    return curves;
}

/// 1, 2 and 5 times powers of ten within the axis.
std::vector<double> round_values(const Axis& axis) {
    std::vector<double> values;
    for (double power = std::pow(10, std::floor(std::log10(axis.low))); power <= axis.high; power *= 10) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            if (digit * power >= axis.low * 0.999 && digit * power <= axis.high * 1.001)
                values.push_back(digit * power);
        }
    }
    return values;
}

void draw_axes(Svg& svg, const Axis& x, const Axis& y, const std::set<double>& sizes) {
    for (const double value : round_values(y)) {
        svg.line(x.begin, y.at(value), x.end, y.at(value), "grid");
        svg.text(x.begin - 8, y.at(value) + 4, fmt::format("{:.0f}", value), "label", Anchor::end);
    }
    double last = -100;
    for (const double size : sizes) {
        svg.line(x.at(size), y.begin, x.at(size), y.begin + 5, "axis");
        if (x.at(size) - last < 34) continue;
        last = x.at(size);
        svg.text(x.at(size), y.begin + 20, fmt::format("{:.0f}", size), "label", Anchor::middle);
    }
    svg.line(x.begin, y.begin, x.end, y.begin, "axis");
    svg.text((x.begin + x.end) / 2, y.begin + 42, "passes", "label", Anchor::middle);
    svg.text(14, (y.begin + y.end) / 2, "ns a pass", "label", Anchor::middle, -90);
}

/// Where the name of each curve goes: as near to its end as the others allow.
std::vector<double> label_places(const std::vector<Curve>& curves, const Axis& y) {
    std::vector<std::pair<double, size_t>> wanted;
    for (size_t i = 0; i < curves.size(); ++i)
        wanted.emplace_back(y.at(curves[i].points.back().second), i);
    std::sort(wanted.begin(), wanted.end());
    for (size_t i = 1; i < wanted.size(); ++i)
        wanted[i].first = std::max(wanted[i].first, wanted[i - 1].first + kLabelGap);
    if (!wanted.empty()) wanted.back().first = std::min(wanted.back().first, y.begin);
    for (size_t i = wanted.size(); i-- > 1;)
        wanted[i - 1].first = std::min(wanted[i - 1].first, wanted[i].first - kLabelGap);
    std::vector<double> places(curves.size());
    for (const auto& [place, curve] : wanted)
        places[curve] = place;
    return places;
}

}  // namespace

std::string draw_growth(const GraphReport& report) {
    const std::vector<Curve> curves = curves_of(report);
    std::set<double> sizes;
    double low = 1e300, high = 0;
    for (const Curve& curve : curves) {
        for (const auto& [passes, ns] : curve.points) {
            if (curve.family == curves.front().family) sizes.insert(passes);
            low = std::min(low, ns);
            high = std::max(high, ns);
        }
    }
    double first = 1e300, last = 0;
    for (const Curve& curve : curves) {
        first = std::min(first, curve.points.front().first);
        last = std::max(last, curve.points.back().first);
    }
    const Axis x{first, std::max(last, first * 2), kLeft, kWidth - kRight};
    const Axis y{low / 1.3, high * 1.3, kHeight - kBottom, kTop};
    Svg svg(kWidth, kHeight, "Compile time a pass over the number of passes");
    draw_axes(svg, x, y, sizes);
    const std::vector<double> places = label_places(curves, y);
    for (size_t i = 0; i < curves.size(); ++i) {
        std::string commands;
        for (const auto& [passes, ns] : curves[i].points)
            commands += fmt::format("{}{:.1f} {:.1f}", commands.empty() ? "M" : " L", x.at(passes), y.at(ns));
        svg.path(commands, fmt::format("curve s{}", i));
        for (const auto& [passes, ns] : curves[i].points) {
            svg.circle(x.at(passes), y.at(ns), 3.5, fmt::format("f{}", i),
                       fmt::format("{}, {:.0f} passes: {:.0f} ns a pass", curves[i].family, passes, ns));
        }
        const auto [passes, ns] = curves[i].points.back();
        svg.line(x.at(passes) + 6, y.at(ns), x.end + 16, places[i], fmt::format("leader s{}", i));
        const auto growth = std::find_if(report.growth.begin(), report.growth.end(),
                                         [&](const Growth& one) { return one.family == curves[i].family; });
        svg.text(x.end + 20, places[i] + 4,
                 growth == report.growth.end() ? curves[i].family
                                               : fmt::format("{}  N^{:.2f}", curves[i].family, growth->exponent),
                 "label strong");
    }
    return svg.finish();
}

}  // namespace splice::bench
