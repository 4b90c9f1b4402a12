#include "tests/reference/metrics.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <stdexcept>

using namespace splice::reference;

namespace {

/// A reference that shows a plane at depth 1 in the square [8, 24) of a 32x32 frame.
DepthImage square_reference() {
    DepthImage image(32, 32, kNothing);
    for (std::uint32_t y = 8; y < 24; ++y)
        for (std::uint32_t x = 8; x < 24; ++x)
            image.at(x, y) = 1;
    return image;
}

Tolerance tolerance(float depth, float radius_px) {
    return {Raster<float>(32, 32, depth), Raster<float>(32, 32, radius_px)};
}

}  // namespace

TEST_CASE("psnr of a constant error of one step is 20 log10 255") {
    const ColourImage a(7, 5, {10, 20, 30}), b(7, 5, {11, 19, 31});
    CHECK(psnr(a, b) == Approx(20 * std::log10(255.0)));
    CHECK(std::isinf(psnr(a, a)));
    CHECK_THROWS_AS(psnr(a, ColourImage(5, 7)), std::invalid_argument);
}

TEST_CASE("psnr over a mask ignores everything outside it") {
    ColourImage a(4, 4), b(4, 4);
    b.at(3, 3) = {255, 255, 255};
    Mask where(4, 4, 1);
    where.at(3, 3) = 0;
    CHECK(std::isinf(psnr(a, b, &where)));
    CHECK(psnr(a, b) == Approx(10 * std::log10(16.0)));
    const Mask none(4, 4, 0);
    CHECK(std::isnan(psnr(a, b, &none)));
}

TEST_CASE("differences are counted, and the largest is found") {
    ColourImage a(4, 4, {10, 20, 30}), b = a;
    CHECK(splice::metrics::count_differences(a, b).pixels == 0);
    b.at(1, 2) = {10, 25, 30};
    b.at(3, 3) = {9, 20, 37};
    const auto found = splice::metrics::count_differences(a, b);
    CHECK(found.pixels == 2);
    CHECK(found.largest == 7);
    CHECK(found.x == 3);
    CHECK(found.y == 3);
}

TEST_CASE("erosion and dilation are Euclidean") {
    Mask dot(9, 9);
    dot.at(4, 4) = 1;
    const Mask grown = dilated(dot, 2);
    CHECK(grown.at(6, 4) == 1);
    CHECK(grown.at(5, 5) == 1);
    CHECK(grown.at(6, 5) == 0);  // at distance sqrt(5)
    CHECK(eroded(grown, 2).pixels == dot.pixels);
    const Mask full(9, 9, 1);
    CHECK(eroded(full, 3).pixels == full.pixels);
}

TEST_CASE("silhouette intersection over union") {
    Mask a(4, 1), b(4, 1);
    a.at(0, 0) = a.at(1, 0) = 1;
    b.at(1, 0) = b.at(2, 0) = 1;
    CHECK(silhouette_iou(a, b) == Approx(1.0 / 3));
    CHECK(silhouette_iou(Mask(2, 2), Mask(2, 2)) == 1);
}

TEST_CASE("a frame equal to the reference is clean") {
    const DepthImage reference = square_reference();
    const SurfaceReport report = check_surface(reference, reference, tolerance(0, 0));
    CHECK(report.clean());
    CHECK(report.inside == 12 * 12);
}

TEST_CASE("a missing pixel inside is a hole, at the border it is none") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(8, 8) = frame.at(9, 12) = kNothing;
    CHECK(check_surface(frame, reference, tolerance(0, 0)).clean());
    frame.at(10, 10) = kNothing;
    const SurfaceReport report = check_surface(frame, reference, tolerance(0, 0));
    CHECK(report.holes == 1);
    CHECK(report.lost == 0);
}

TEST_CASE("a surface shining through from behind the tolerance is a hole") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(12, 12) = 1.05f;
    CHECK(check_surface(frame, reference, tolerance(0.1f, 0)).clean());
    const SurfaceReport report = check_surface(frame, reference, tolerance(0.01f, 0));
    CHECK(report.holes == 1);
    CHECK(report.worst_behind == Approx(0.04).epsilon(0.01));
}

TEST_CASE("a thin feature without cover within a pixel is lost") {
    DepthImage reference(32, 32, kNothing), frame(32, 32, kNothing);
    for (std::uint32_t y = 0; y < 32; ++y)
        reference.at(16, y) = 1;
    CHECK(check_surface(frame, reference, tolerance(0, 0)).lost == 32);
    for (std::uint32_t y = 0; y < 32; ++y)
        frame.at(17, y) = 1;
    CHECK(check_surface(frame, reference, tolerance(0, 0)).clean());
}

TEST_CASE("cover outside the reference is growth beyond two pixels or beyond one and the disk") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(16, 25) = 1;  // two pixels outside
    CHECK(check_surface(frame, reference, tolerance(0, 0)).clean());
    frame.at(16, 26) = 1;
    CHECK(check_surface(frame, reference, tolerance(0, 0)).grown == 1);
    CHECK(check_surface(frame, reference, tolerance(0, 2)).clean());
}

TEST_CASE("a surface in front of the reference is counted") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(12, 12) = 0.9f;
    CHECK(check_surface(frame, reference, tolerance(0.2f, 0)).in_front == 0);
    const SurfaceReport report = check_surface(frame, reference, tolerance(0.05f, 0));
    CHECK(report.in_front == 1);
    CHECK(report.worst_in_front == Approx(0.05));
    CHECK_FALSE(report.clean());
}

TEST_CASE("slivers between the reference's rays count when a pixel is looked at closer") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(12, 12) = 0.5f;  // a nearer part in the column beside it
    frame.at(16, 27) = 1;     // over a whisker three pixels outside
    CHECK(check_surface(frame, reference, tolerance(0, 0)).in_front == 1);
    CHECK(check_surface(frame, reference, tolerance(0, 0)).grown == 1);
    const auto closer = [&](std::uint32_t x, std::uint32_t y) {
        const float depth = x == 13 ? 0.5f : x == 16 && y > 23 ? 1.0f : reference.at(x, y);
        return DepthRange{depth, depth};
    };
    CHECK(check_surface(frame, reference, tolerance(0, 0), nullptr, closer).clean());
    frame.at(10, 10) = 0.5f;
    CHECK(check_surface(frame, reference, tolerance(0, 0), nullptr, closer).in_front == 1);
}

TEST_CASE("what shows through a crack of the reference itself is no hole") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(12, 12) = 2;
    frame.at(18, 18) = kNothing;
    CHECK(check_surface(frame, reference, tolerance(0, 0)).holes == 2);
    const auto closer = [&](std::uint32_t x, std::uint32_t y) {
        const float behind = x == 13 ? 2.0f : x == 18 && y == 17 ? kNothing : 1.0f;
        return DepthRange{1.0f, behind};
    };
    CHECK(check_surface(frame, reference, tolerance(0, 0), nullptr, closer).clean());
    frame.at(12, 12) = 2.5f;
    CHECK(check_surface(frame, reference, tolerance(0, 0), nullptr, closer).holes == 1);
}

TEST_CASE("the marked picture shows each kind of fault in its own colour") {
    const DepthImage reference = square_reference();
    DepthImage frame = reference;
    frame.at(12, 12) = kNothing;
    frame.at(14, 14) = 0.5f;
    frame.at(16, 30) = 1;
    ColourImage marked;
    check_surface(frame, reference, tolerance(0, 0), &marked);
    CHECK(marked.at(12, 12) == Rgb8{255, 0, 0});
    CHECK(marked.at(14, 14) == Rgb8{255, 0, 255});
    CHECK(marked.at(16, 30) == Rgb8{255, 255, 0});
    CHECK(marked.at(20, 20) == Rgb8{80, 80, 80});
}
