#include "preprocess/cloud/voronoi_cell.h"

#include <algorithm>
#include <cmath>

namespace splice {

VoronoiCell::VoronoiCell(float limit) : reach_(2 * limit * limit) {
    corner_[0] = {limit, limit};
    corner_[1] = {-limit, limit};
    corner_[2] = {-limit, -limit};
    corner_[3] = {limit, -limit};
    std::fill_n(edge_.begin(), 4, kLimit);
}

// Sutherland and Hodgman 1974, with the one half-plane x . site <= |site|^2 / 2.
bool VoronoiCell::cut(const Eigen::Vector2f& site, std::uint32_t number) {
    const float half = site.squaredNorm() / 2;
    // The bisector is |site| / 2 away.
    if (half / 2 >= reach_ || count_ + 1 > kMostCorners) return false;
    std::array<float, kMostCorners> outside;
    std::size_t cut = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        outside[i] = corner_[i].dot(site) - half;
        cut += outside[i] > 0;
    }
    // All of it only by rounding: the origin is inside.
    if (cut == 0 || cut == count_) return false;
    // The polygon is convex: what is outside is one run of corners, from `first` to the one before `end`.
    const auto after = [&](std::size_t i) { return i + 1 == count_ ? 0 : i + 1; };
    std::size_t before = 0;
    while (outside[before] > 0 || outside[after(before)] <= 0)
        before = after(before);
    const std::size_t first = after(before);
    std::size_t last = first;
    while (outside[after(last)] > 0)
        last = after(last);
    const std::size_t end = after(last);
    const auto crossing = [&](std::size_t i, std::size_t next) -> Eigen::Vector2f {
        return corner_[i] + (corner_[next] - corner_[i]) * (outside[i] / (outside[i] - outside[next]));
    };
    const Eigen::Vector2f entry = crossing(before, first), exit = crossing(last, end);
    const std::uint32_t exit_edge = edge_[last];
    // Two corners take the place of the run.
    std::size_t place = first;
    const auto move_to = [&](auto& values, std::size_t from, std::size_t to, std::size_t count) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from),
                   target = values.begin() + static_cast<std::ptrdiff_t>(to);
        if (to <= from) {
            std::copy_n(begin, count, target);
        } else {
            std::copy_backward(begin, begin + static_cast<std::ptrdiff_t>(count),
                               target + static_cast<std::ptrdiff_t>(count));
        }
    };
    if (first <= last) {
        move_to(corner_, last + 1, first + 2, count_ - last - 1);
        move_to(edge_, last + 1, first + 2, count_ - last - 1);
        count_ = count_ - (last - first + 1) + 2;
    } else {
        move_to(corner_, end, 0, first - end);
        move_to(edge_, end, 0, first - end);
        place = first - end;
        count_ = place + 2;
    }
    corner_[place] = entry;
    corner_[place + 1] = exit;
    edge_[place] = number;
    edge_[place + 1] = exit_edge;
    reach_ = 0;
    for (std::size_t i = 0; i < count_; ++i)
        reach_ = std::max(reach_, corner_[i].squaredNorm());
    return true;
}

float VoronoiCell::reach(bool bounded_only) const {
    if (!bounded_only) return std::sqrt(reach_);
    float squared = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const std::size_t before = i == 0 ? count_ - 1 : i - 1;
        if (edge_[i] != kLimit && edge_[before] != kLimit) squared = std::max(squared, corner_[i].squaredNorm());
    }
    return std::sqrt(squared);
}

bool VoronoiCell::is_bounded() const {
    return std::none_of(edge_.begin(), edge_.begin() + static_cast<std::ptrdiff_t>(count_),
                        [](std::uint32_t edge) { return edge == kLimit; });
}

}  // namespace splice
