#include "engine/scene/kernel.h"

#include <charconv>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <vector>

namespace splice {

namespace {

constexpr float kPaperSupport = 1.5f;  // figure 8

// Numbers between commas.
std::optional<std::vector<float>> numbers_in(std::string_view text) {
    std::vector<float> numbers;
    const char* next = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        float value = 0;
        const auto [after, error] = std::from_chars(next, end, value);
        if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
        numbers.push_back(value);
        if (after == end) return numbers;
        if (*after != ',') return std::nullopt;
        next = after + 1;
    }
}

bool between(float value, float least, float most) {
    return value >= least && value <= most;
}

// Variance along an axis of what weighs psi(r) at distance r: integral of psi r^3 over twice that of psi r.
float moment_of(const Kernel& kernel) {
    constexpr int kSteps = 4096;
    double cubes = 0, all = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double r = (i + 0.5) / kSteps * static_cast<double>(kernel.support);
        const double weight = kernel_weight(kernel, r);
        cubes += weight * r * r * r;
        all += weight * r;
    }
    return static_cast<float>(cubes / (2 * all));
}

}  // namespace

double kernel_weight(const Kernel& kernel, double r) {
    const auto support = static_cast<double>(kernel.support), a = static_cast<double>(kernel.a);
    if (r >= support) return 0;
    switch (kernel.shape) {
        case KernelShape::kDisk:
            return std::exp(-r * r);
        case KernelShape::kGaussian:
            return std::exp(-a * r * r);
        case KernelShape::kConfetti: {
            const double share = std::pow(r / support, static_cast<double>(kernel.n));
            return std::exp(-a * share / (1 - share));
        }
        case KernelShape::kConstant:
            return 1;
    }
    return 0;
}

std::string text_of(const Kernel& kernel) {
    if (kernel.shape == KernelShape::kDisk) return "disk";
    if (kernel.shape == KernelShape::kConstant) return "constant";
    const bool gaussian = kernel.shape == KernelShape::kGaussian;
    // As few digits as give the same kernel: it is people that read scene files.
    std::string text;
    for (int digits = 2; digits <= std::numeric_limits<float>::max_digits10; ++digits) {
        std::ostringstream out;
        out << std::setprecision(digits);
        if (gaussian) {
            out << "gaussian:" << std::sqrt(kernel.moment);
        } else {
            out << "confetti:" << kernel.a << ',' << kernel.support << ',' << kernel.n;
        }
        text = out.str();
        if (parse_kernel(text) == kernel) break;
    }
    return text;
}

std::optional<Kernel> parse_kernel(std::string_view text) {
    Kernel kernel;
    if (text == "disk") return kernel;
    if (text == "constant") {
        kernel.shape = KernelShape::kConstant;
        kernel.moment = moment_of(kernel);
        return kernel;
    }
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const auto numbers = numbers_in(text.substr(colon + 1));
    const std::string_view name = text.substr(0, colon);
    if (!numbers) return std::nullopt;
    if (name == "gaussian" && numbers->size() == 1 && between(numbers->front(), 0.05f, 10)) {
        const float sigma = numbers->front();
        return Kernel{KernelShape::kGaussian, kPaperSupport, sigma * sigma, 0.5f / (sigma * sigma), 0};
    }
    if (name == "confetti" && numbers->size() == 3 && between((*numbers)[0], 0.01f, 100) &&
        between((*numbers)[1], 0.1f, 4) && between((*numbers)[2], 0.5f, 32)) {
        kernel = {KernelShape::kConfetti, (*numbers)[1], 0, (*numbers)[0], (*numbers)[2]};
        kernel.moment = moment_of(kernel);
        return kernel;
    }
    return std::nullopt;
}

}  // namespace splice
