// What repeated measurements of one thing come to.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace splice::bench {

struct Sample {
    double median = 0, minimum = 0;
    double lower_quartile = 0, upper_quartile = 0;
};

/// Quartiles and median are values that were measured, without interpolation. All 0 for no values.
Sample summarise(std::vector<double> values);
/// Every figure times `factor`.
Sample scaled(const Sample& sample, double factor);

/// b of y = a x^b through (x, y), all positive: least squares of the logarithms. NaN for fewer than two different x.
double growth_exponent(std::span<const std::pair<double, double>> points);

}  // namespace splice::bench
