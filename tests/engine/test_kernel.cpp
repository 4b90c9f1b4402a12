// Blending kernels (Pajarola et al. 2004, section 5.2).
#include "engine/scene/kernel.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;

TEST_CASE("kernels are 1 in the middle, fall, and are nothing beyond their support") {
    for (const char* name : {"gaussian:0.3", "gaussian:0.5", "confetti:1,1.5,2", "confetti:6,1.5,3", "constant"}) {
        const Kernel kernel = parse_kernel(name).value();
        CAPTURE(name);
        CHECK(kernel_weight(kernel, 0) == 1);
        double before = 1;
        for (double r = 0.01; r < static_cast<double>(kernel.support); r += 0.01) {
            const double weight = kernel_weight(kernel, r);
            CHECK(weight >= 0);
            CHECK(weight <= before);
            before = weight;
        }
        CHECK(kernel_weight(kernel, static_cast<double>(kernel.support)) == 0);
    }
}

TEST_CASE("kernels have the values that their equations give") {
    CHECK(kernel_weight(parse_kernel("gaussian:0.5").value(), 0.5) == Approx(std::exp(-0.5)));
    // (r / b)^n = 0.25
    CHECK(kernel_weight(parse_kernel("confetti:3,1.5,2").value(), 0.75) == Approx(std::exp(-1.0)));
    CHECK(parse_kernel("gaussian:0.3")->moment == Approx(0.09));
    // Of a uniform disk, r^2 / 4.
    CHECK(parse_kernel("constant")->moment == Approx(0.25).epsilon(1e-4));
    // A plateau is wider than a peak.
    CHECK(parse_kernel("confetti:4,1.5,5")->moment > parse_kernel("confetti:6,1.5,3")->moment);
}

TEST_CASE("a kernel's text is the kernel again, in few digits") {
    for (const char* name : {"disk", "constant", "gaussian:0.3", "gaussian:0.123", "gaussian:10", "confetti:1,1.5,2",
                             "confetti:0.01,0.1,32", "confetti:4,1.25,5"}) {
        CHECK(text_of(parse_kernel(name).value()) == name);
    }
}

TEST_CASE("what is no kernel is refused") {
    for (const char* text : {"", "gaussian", "gaussian:", "gaussian:0", "gaussian:nan", "gaussian:1,2", "confetti:1,2",
                             "confetti:1,1.5,2,", "confetti:1,5,2", "constant:1", "box", "gaussian:0.5x"})
        CHECK_FALSE(parse_kernel(text));
}
