// How much a splat weighs at r radii from its centre (Pajarola et al. 2004, section 5.2).
//   gaussian:SIGMA    exp(-r^2 / 2 sigma^2)                        equation (9); the paper's: 0.3, 0.5, 0.8
//   confetti:A,B,N    exp(-a (r/b)^n / (1 - (r/b)^n)) below b      equation (10), whose (r - b)^n is a slip for
//   (r/b)^n;
//                     the paper's: 1,1.5,2  6,1.5,3  4,1.5,5
//   constant          1 on the disk
// Nothing beyond `support` counts. The default is a Gaussian cut at the disk's rim.
//
// A Gaussian filtered by the pixel's is a Gaussian (EWA). Of other kernels the filtered form is not known; as a
// substitute their footprint grows to the variance that filtering would give it and keeps its shape, which for a
// Gaussian is the same.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace splice {

/// Values are shared with shaders/glsl/include/splat.glsl.
enum class KernelShape : std::uint32_t { kDisk = 0, kGaussian = 1, kConfetti = 2, kConstant = 3 };

struct Kernel {
    KernelShape shape = KernelShape::kDisk;  // the default: sigma^2 = 1/2
    float support = 1;                       // radii; confetti: b
    float moment = 0.5f;                     // variance along an axis, radii^2
    float a = 0, n = 0;                      // confetti; gaussian: a = 1 / (2 sigma^2)
    auto operator<=>(const Kernel&) const = default;
};

/// "disk", "gaussian:SIGMA", "confetti:A,B,N" or "constant": sigma in 0.05..10; a in 0.01..100; b in 0.1..4; n in
/// 0.5..32. Nothing where the text is none of these.
std::optional<Kernel> parse_kernel(std::string_view text);

/// Parsed, it is the same kernel again.
std::string text_of(const Kernel& kernel);

/// Its weight at r radii.
double kernel_weight(const Kernel& kernel, double r);

}  // namespace splice
