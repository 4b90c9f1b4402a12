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
    bool any = false;
    for (std::size_t i = 0; i < count_; ++i) {
        outside[i] = corner_[i].dot(site) - half;
        any = any || outside[i] > 0;
    }
    if (!any) return false;
    std::array<Eigen::Vector2f, kMostCorners> corner;
    std::array<std::uint32_t, kMostCorners> edge;
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const std::size_t next = i + 1 == count_ ? 0 : i + 1;
        if (outside[i] <= 0) {
            corner[count] = corner_[i];
            edge[count++] = edge_[i];
        }
        if ((outside[i] <= 0) == (outside[next] <= 0)) continue;
        corner[count] = corner_[i] + (corner_[next] - corner_[i]) * (outside[i] / (outside[i] - outside[next]));
        edge[count++] = outside[i] <= 0 ? number : edge_[i];
    }
    count_ = count;
    std::copy_n(corner.begin(), count, corner_.begin());
    std::copy_n(edge.begin(), count, edge_.begin());
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
