// splice-compare as a user meets it: figures, limits, exit codes.
#include "engine/capture/png_file.h"
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

using namespace splice;
using namespace splice::test;

namespace {

Outcome compare(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    return run({.program = program("splice-compare"), .arguments = std::move(arguments), .folder = folder.path()});
}

/// A disk of radius 12 around (x, 16) in a 32x32 picture.
Picture disk(double x, std::array<std::uint8_t, 4> colour, std::array<std::uint8_t, 4> background) {
    Picture picture{32, 32, {}};
    for (int row = 0; row < 32; ++row)
        for (int column = 0; column < 32; ++column) {
            const auto& pixel = std::hypot(column - x, row - 16.0) <= 12 ? colour : background;
            picture.rgba.insert(picture.rgba.end(), pixel.begin(), pixel.end());
        }
    return picture;
}

nlohmann::json figures(const TemporaryFolder& folder) {
    return nlohmann::json::parse(std::ifstream(folder / "out.json"));
}

constexpr std::array<std::uint8_t, 4> kOrange{200, 100, 50, 255}, kNearOrange{203, 100, 50, 255},
    kWhitePixel{255, 255, 255, 255}, kClear{0, 0, 0, 0};

}  // namespace

TEST_CASE("splice-compare finds equal pictures equal") {
    const TemporaryFolder folder;
    write_png(folder / "a.png", disk(16, kOrange, kWhitePixel));
    const Outcome outcome = compare(folder, {"a.png", "a.png", "--json", "out.json", "--min-psnr", "100",
                                             "--max-difference", "0", "--max-differing", "0"});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err == "");
    CHECK_THAT(outcome.out, Catch::Contains("infinite"));
    const nlohmann::json json = figures(folder);
    CHECK(json["identical"] == true);
    CHECK(json["psnr_db"].is_null());
    CHECK(json["inside_db"].is_null());
    CHECK(json["iou"].is_null());
}

TEST_CASE("splice-compare measures over the frame and inside, counts and draws differences") {
    const TemporaryFolder folder;
    write_png(folder / "a.png", disk(16, kNearOrange, kWhitePixel));
    write_png(folder / "b.png", disk(16, kOrange, kWhitePixel));
    const Outcome outcome = compare(folder, {"a.png", "b.png", "--background", "white", "--json", "out.json", "--diff",
                                             "diff.png", "--gain", "10"});
    CHECK(outcome.exit_code == 0);
    const nlohmann::json json = figures(folder);
    // 3 levels in one of three channels.
    CHECK(json["inside_db"].get<double>() == Approx(10 * std::log10(255.0 * 255 / 3)));
    CHECK(json["psnr_db"].get<double>() > json["inside_db"].get<double>());
    CHECK(json["largest_difference"]["levels"] == 3);
    CHECK(json["iou"] == 1.0);
    const auto pixels = json["differing_pixels"].get<int>();
    CHECK(pixels > json["inside_pixels"].get<int>());
    const Picture diff = read_png(folder / "diff.png");
    int marked = 0;
    for (std::size_t i = 0; i < diff.rgba.size(); i += 4)
        marked += diff.rgba[i] == 30 ? 1 : 0;
    CHECK(marked == pixels);
}

TEST_CASE("splice-compare takes the object from alpha, from a background colour, from a mask") {
    const TemporaryFolder folder;
    write_png(folder / "a.png", disk(15, kOrange, kClear));
    write_png(folder / "b.png", disk(16, kOrange, kClear));
    CHECK(compare(folder, {"a.png", "b.png", "--json", "out.json"}).exit_code == 0);
    const double iou = figures(folder)["iou"].get<double>();
    CHECK(iou > 0.85);
    CHECK(iou < 0.95);
    CHECK(figures(folder)["inside_db"].is_null());  // equal there
    const auto inside = figures(folder)["inside_pixels"].get<int>();
    CHECK(inside > 100);

    write_png(folder / "a2.png", disk(15, kOrange, kWhitePixel));
    write_png(folder / "b2.png", disk(16, kOrange, kWhitePixel));
    CHECK(compare(folder, {"a2.png", "b2.png", "--background", "#ffffff", "--json", "out.json"}).exit_code == 0);
    CHECK(figures(folder)["iou"].get<double>() == Approx(iou));

    write_png(folder / "mask.png", disk(16, kWhitePixel, {0, 0, 0, 255}));
    CHECK(compare(folder, {"a2.png", "b2.png", "--mask", "mask.png", "--json", "out.json"}).exit_code == 0);
    CHECK(figures(folder)["inside_pixels"] == inside);
    CHECK(figures(folder)["iou"].is_null());
    CHECK(compare(folder, {"a2.png", "b2.png", "--mask", "mask.png", "--erode", "0", "--json", "out.json"}).exit_code ==
          0);
    CHECK(figures(folder)["inside_pixels"].get<int>() > inside);
}

TEST_CASE("splice-compare fails where a limit does not hold, and says which") {
    const TemporaryFolder folder;
    write_png(folder / "a.png", disk(15, kNearOrange, kClear));
    write_png(folder / "b.png", disk(16, kOrange, kClear));
    for (const auto& [option, value, words] :
         std::vector<std::array<const char*, 3>>{{"--min-psnr", "60", "PSNR is"},
                                                 {"--min-inside", "60", "PSNR inside is"},
                                                 {"--min-iou", "0.99", "silhouette IoU is"},
                                                 {"--max-difference", "2", "the largest difference is"},
                                                 {"--max-differing", "10", "pixels differ, more than 10"}}) {
        INFO(option);
        const Outcome outcome = compare(folder, {"a.png", "b.png", option, value, "--json", "out.json"});
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Catch::StartsWith("splice-compare: ") && Catch::Contains(words));
        CHECK(figures(folder)["broken"].size() == 1);
    }
    CHECK(compare(folder, {"a.png", "b.png", "--min-psnr", "10", "--min-iou", "0.5"}).exit_code == 0);
    // A limit on what is not known does not hold.
    write_png(folder / "c.png", disk(16, kOrange, kWhitePixel));
    const Outcome unknown = compare(folder, {"c.png", "c.png", "--min-iou", "0.5"});
    CHECK(unknown.exit_code == 1);
    CHECK_THAT(unknown.err, Catch::Contains("is not known"));
}

TEST_CASE("splice-compare tells a wrong command line from a wrong file") {
    const TemporaryFolder folder;
    write_png(folder / "a.png", disk(16, kOrange, kWhitePixel));
    Picture small{2, 2, std::vector<std::uint8_t>(16, 255)};
    write_png(folder / "small.png", small);
    std::ofstream(folder / "text.png") << "no picture";
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"a.png"},
                                               {"a.png", "a.png", "--erode", "-1"},
                                               {"a.png", "a.png", "--background", "beige"},
                                               {"a.png", "a.png", "--diff", "a.png"},
                                               {"a.png", "a.png", "--min-psnr", "x"},
                                               {"a.png", "a.png", "--min-psnr", "nan"},
                                               {"a.png", "a.png", "--erode", "nan"}}) {
        const Outcome outcome = compare(folder, arguments);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.out == "");
    }
    for (const char* other : {"small.png", "text.png", "absent.png"}) {
        const Outcome outcome = compare(folder, {"a.png", other, "--diff", "diff.png"});
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Catch::Contains(other));
        CHECK_FALSE(std::filesystem::exists(folder / "diff.png"));
    }
}
