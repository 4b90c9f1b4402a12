#include "engine/bench/graph/figures.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace splice::bench {
namespace {

constexpr double kWidth = 1040, kHeight = 420, kLeft = 64, kRight = 20, kTop = 22, kBottom = 50, kFont = 10;
constexpr size_t kColours = 9;

std::string megabytes(double bytes) {
    return bytes >= 10e6 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} MB", bytes / 1e6);
}

/// Bytes alive in each group, wherever they lie.
std::vector<uint64_t> live_bytes(const ExampleGraph& example) {
    std::vector<uint64_t> live(example.groups, 0);
    for (const PlacedResource& resource : example.placed) {
        for (uint32_t group = resource.first_group; group <= resource.last_group; ++group)
            live[group] += resource.size;
    }
    return live;
}

}  // namespace

std::string draw_lifetimes(const ExampleGraph& example) {
    Svg svg(kWidth, kHeight, fmt::format("Memory of the {} graph: offset against group", example.family));
    const double bottom = kHeight - kBottom;
    const auto most = static_cast<double>(std::max<uint64_t>(std::max(example.heap_bytes, example.lower_bound), 1));
    const auto x = [&](double group) { return kLeft + group / example.groups * (kWidth - kLeft - kRight); };
    const auto y = [&](double bytes) { return bottom - bytes / most * (bottom - kTop); };

    for (int tick = 0; tick <= 4; ++tick) {
        const double bytes = most * tick / 4;
        svg.line(kLeft, y(bytes), kWidth - kRight, y(bytes), "grid");
        svg.text(kLeft - 8, y(bytes) + 4, megabytes(bytes), "label", Anchor::end);
    }
    const uint32_t step = std::max(1U, (example.groups + 15) / 16);
    for (uint32_t group = 0; group < example.groups; group += step)
        svg.text(x(group + 0.5), bottom + 18, fmt::format("{}", group), "label", Anchor::middle);
    svg.text((kLeft + kWidth - kRight) / 2, bottom + 40, "group (render pass), in recorded order", "label",
             Anchor::middle);

    for (size_t i = 0; i < example.placed.size(); ++i) {
        const PlacedResource& resource = example.placed[i];
        const double left = x(resource.first_group), right = x(resource.last_group + 1.0);
        const auto begin = static_cast<double>(resource.offset), size = static_cast<double>(resource.size);
        const double top = y(begin + size), height = y(begin) - top;
        svg.rectangle(left, top, right - left, height, fmt::format("live f{}", i % kColours),
                      fmt::format("{}: groups {} to {}, {} at {}", resource.name, resource.first_group,
                                  resource.last_group, megabytes(size), megabytes(begin)));
    }

    std::string outline;
    const std::vector<uint64_t> live = live_bytes(example);
    for (size_t group = 0; group < live.size(); ++group) {
        const double height = y(static_cast<double>(live[group]));
        outline += fmt::format("{}{:.1f} {:.1f} L{:.1f} {:.1f}", group == 0 ? "M" : " L", x(static_cast<double>(group)),
                               height, x(static_cast<double>(group) + 1), height);
    }
    svg.path(outline, "alive", "bytes alive in each group: the largest of them is the lower bound");
    const double bound = y(static_cast<double>(example.lower_bound));
    svg.line(kLeft, bound, kWidth - kRight, bound, "bound");
    // Last, so that nothing crosses a name.
    for (const PlacedResource& resource : example.placed) {
        const double left = x(resource.first_group), right = x(resource.last_group + 1.0);
        const auto begin = static_cast<double>(resource.offset), size = static_cast<double>(resource.size);
        const double height = y(begin) - y(begin + size);
        if (height >= kFont + 2 && text_width(resource.name, kFont) + 6 <= right - left)
            svg.text((left + right) / 2, y(begin + size / 2) + kFont * 0.35, resource.name, "inside", Anchor::middle);
    }
    svg.text(kWidth - kRight, kTop - 8,
             fmt::format("placed {}, lower bound {} (dashed); line: bytes alive",
                         megabytes(static_cast<double>(example.heap_bytes)),
                         megabytes(static_cast<double>(example.lower_bound))),
             "label", Anchor::end);
    return svg.finish();
}

}  // namespace splice::bench
