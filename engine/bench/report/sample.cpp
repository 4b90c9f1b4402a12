#include "engine/bench/report/sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace splice::bench {

Sample summarise(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    return {.median = values[last / 2],
            .minimum = values.front(),
            .lower_quartile = values[last / 4],
            .upper_quartile = values[last - last / 4]};
}

Sample scaled(const Sample& sample, double factor) {
    return {sample.median * factor, sample.minimum * factor, sample.lower_quartile * factor,
            sample.upper_quartile * factor};
}

double growth_exponent(std::span<const std::pair<double, double>> points) {
    double mean_x = 0, mean_y = 0;
    for (const auto& [x, y] : points) {
        mean_x += std::log(x) / static_cast<double>(points.size());
        mean_y += std::log(y) / static_cast<double>(points.size());
    }
    double covariance = 0, variance = 0;
    for (const auto& [x, y] : points) {
        covariance += (std::log(x) - mean_x) * (std::log(y) - mean_y);
        variance += (std::log(x) - mean_x) * (std::log(x) - mean_x);
    }
    return variance > 0 ? covariance / variance : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace splice::bench
