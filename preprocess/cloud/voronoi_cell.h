// The part of a tangent plane that is nearer to the origin than to any of some points: what a disk at the origin must
// cover if each point's disk covers its own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

namespace splice {

class VoronoiCell {
  public:
    /// Starts as the square of half-width `limit`, which is at least 0.
    explicit VoronoiCell(float limit);

    /// Cuts off what is nearer to `site` (not 0). `number` comes back from neighbours(). False if nothing was cut.
    bool cut(const Eigen::Vector2f& site, std::uint32_t number);

    /// Distance of the farthest corner; `bounded_only`: of those between two sites, 0 if there is none.
    float reach(bool bounded_only) const;
    /// Between sites all around.
    bool is_bounded() const;
    /// Numbers of the sites that it borders on.
    template <class Visit>
    void neighbours(const Visit& visit) const {
        for (std::size_t i = 0; i < count_; ++i)
            if (edge_[i] != kLimit) visit(edge_[i]);
    }

  private:
    static constexpr std::uint32_t kLimit = 0xffffffffu;
    // A convex polygon has one edge more than half-planes have cut it; more would only be lost detail.
    static constexpr std::size_t kMostCorners = 48;

    std::size_t count_ = 4;
    std::array<Eigen::Vector2f, kMostCorners> corner_;
    std::array<std::uint32_t, kMostCorners> edge_;  // from corner i to the next
    float reach_;                                   // of the farthest corner, squared
};

}  // namespace splice
