// An ellipse along the axes of a distribution, just large enough for some disks (Pajarola et al. 2004, section 4.3 and
// figure 5). Two corrections: an axis is the square root of a covariance's eigenvalue, not the eigenvalue; and the
// eigenvalues are the roots of lambda^2 - trace lambda + det. One change: the paper scales the ellipse of the
// covariance until it holds the disks, which makes it several times too long where the disks are few or large beside
// their distances. Here the covariance gives the direction alone. No ellipse is shorter than the circle that holds all;
// this one is a tenth longer than that circle, and as narrow as it may then be.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>

namespace splice {

/// std::hypot is several times as slow, for numbers too large or small to be squared.
inline double length_of(double x, double y) {
    return std::sqrt(x * x + y * y);
}

struct Ellipse {
    Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  // of the major half axis, unit
    double major = 0, minor = 0;
};

/// Axes as long as the standard deviations. Of one point: of no length, along x.
inline Ellipse ellipse_of(const Eigen::Matrix2d& covariance) {
    const double middle = (covariance(0, 0) + covariance(1, 1)) / 2;
    const double difference = (covariance(0, 0) - covariance(1, 1)) / 2;
    const double radius = length_of(difference, covariance(0, 1));
    Ellipse ellipse;
    if (!(middle + radius > 0)) return ellipse;
    const double angle = std::atan2(covariance(0, 1), difference) / 2;
    ellipse.axis = {std::cos(angle), std::sin(angle)};
    ellipse.major = std::sqrt(middle + radius);
    ellipse.minor = std::sqrt(std::max(middle - radius, 0.0));
    return ellipse;
}

/// Something flat that an ellipse is to hold, in the coordinates of the ellipse's axes, its centre the origin.
struct Footprint {
    double x = 0, y = 0;              // its middle
    double reach_x = 0, reach_y = 0;  // how far it goes from there along each axis
    double radius = 0;                // how far in any direction
};

/// The least minor half axis with which an ellipse of half axis `major`, more than the footprint's farthest point is
/// from the centre, holds a footprint: the lesser of two bounds, around its rectangle and around its circle.
inline double minor_to_hold(const Footprint& footprint, double major) {
    const double x = std::abs(footprint.x), y = std::abs(footprint.y);
    const double corner = (x + footprint.reach_x) / major, middle = x / major;
    const double rectangle = (y + footprint.reach_y) / std::sqrt(std::max(1 - corner * corner, 1e-12));
    // hypot(x / major, y / minor) + radius / minor <= 1
    const double rest = 1 - middle * middle, radius = footprint.radius;
    const double circle = (radius + std::sqrt(middle * middle * radius * radius + rest * y * y)) / rest;
    return std::min(rectangle, circle);
}

/// The longer of the two ellipses that are tried, over the circle.
inline constexpr double kLongerThanCircle = 1.1;

/// Half axes of an ellipse about the origin, along the footprints' axes, that holds them all. `axis` is left alone.
inline Ellipse ellipse_around(std::span<const Footprint> footprints) {
    Ellipse ellipse;
    for (const Footprint& footprint : footprints)
        ellipse.major = std::max(ellipse.major, length_of(footprint.x, footprint.y) + footprint.radius);
    const double circle = ellipse.major, longer = kLongerThanCircle * circle;
    for (const Footprint& footprint : footprints)
        ellipse.minor = std::max(ellipse.minor, minor_to_hold(footprint, longer));
    if (longer * ellipse.minor < circle * circle) {
        ellipse.major = longer;
    } else {
        ellipse.minor = circle;
    }
    return ellipse;
}

}  // namespace splice
