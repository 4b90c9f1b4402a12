// An ellipse with the axes of a distribution, just large enough for some disks (Pajarola et al. 2004, section 4.3 and
// figure 5). Two corrections: an axis is the square root of a covariance's eigenvalue, not the eigenvalue; and the
// eigenvalues are the roots of lambda^2 - trace lambda + det.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace splice {

struct Ellipse {
    Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  // of the major half axis, unit
    double major = 0, minor = 0;
};

/// Axes in the ratio of the standard deviations. Points on a line would make an ellipse without width, and the factor
/// that fits it around their disks infinite: the minor axis is at least a quarter of the major one. Of one point: a
/// circle of radius 1.
inline Ellipse ellipse_of(const Eigen::Matrix2d& covariance) {
    constexpr double kThinnest = 0.25;
    const double middle = (covariance(0, 0) + covariance(1, 1)) / 2;
    const double difference = (covariance(0, 0) - covariance(1, 1)) / 2;
    const double radius = std::hypot(difference, covariance(0, 1));
    Ellipse ellipse;
    if (!(middle + radius > 0)) {
        ellipse.major = ellipse.minor = 1;
        return ellipse;
    }
    const double angle = std::atan2(covariance(0, 1), difference) / 2;
    ellipse.axis = {std::cos(angle), std::sin(angle)};
    ellipse.major = std::sqrt(middle + radius);
    ellipse.minor = std::max(std::sqrt(std::max(middle - radius, 0.0)), kThinnest * ellipse.major);
    return ellipse;
}

/// The least factor on the ellipse's axes that makes it hold what lies within `reach_major` and `reach_minor` of
/// `centre` along its axes; the smaller of two bounds, around the rectangle and around the circle of the larger reach.
inline double factor_to_hold(const Ellipse& ellipse, const Eigen::Vector2d& centre, double reach_major,
                             double reach_minor) {
    const double x = std::abs(centre.dot(ellipse.axis));
    const double y = std::abs(centre.y() * ellipse.axis.x() - centre.x() * ellipse.axis.y());
    const double rectangle = std::hypot((x + reach_major) / ellipse.major, (y + reach_minor) / ellipse.minor);
    const double circle =
        std::hypot(x / ellipse.major, y / ellipse.minor) + std::max(reach_major, reach_minor) / ellipse.minor;
    return std::min(rectangle, circle);
}

}  // namespace splice
