#include "engine/compare/compare_command.h"

#include "engine/compare/comparison_report.h"
#include "engine/scene/scene_file.h"
#include "preprocess/build_model/distinct_files.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace splice {

namespace {

constexpr const char* kFooter =
    "Colours are 8-bit sRGB. Pictures with alpha are laid over the background, white without --background.\n"
    "What is object (PSNR inside, IoU): --mask; else where alpha is at least a half; else, with --background, what is\n"
    "not of that colour.\n"
    "Exit code: 0 every limit given holds (without any: always), 1 one does not, or a file cannot be read or written\n"
    "or has another size, 2 wrong usage.";

void check_files(const CompareCommand& command) {
    std::vector<NamedFile> inputs = {{"A", command.first}, {"B", command.second}}, outputs;
    if (command.mask) inputs.push_back({"--mask", *command.mask});
    if (command.diff) outputs.push_back({"--diff", *command.diff});
    if (command.json) outputs.push_back({"--json", *command.json});
    check_distinct_files(inputs, outputs);
    for (const NamedFile& output : outputs)
        check_output_path(output.path);
}

void write_difference(const CompareCommand& command, const PictureComparison& comparison) {
    const metrics::ColourImage errors = metrics::difference(comparison.first, comparison.second, command.gain);
    Picture picture{errors.width, errors.height, {}};
    for (const metrics::Rgb8 pixel : errors.pixels)
        picture.rgba.insert(picture.rgba.end(), {pixel.r, pixel.g, pixel.b, 255});
    write_png(*command.diff, picture);
}

}  // namespace

std::optional<CompareCommand> parse_compare_command(int argc, const char* const* argv) {
    CompareCommand command;
    std::string background;
    CLI::App app("Measures how far two pictures differ; B is the reference.", "splice-compare");
    app.footer(kFooter);
    app.set_version_flag("--version", "splice-compare " SPLICE_VERSION);
    app.add_option("A", command.first, "A picture, PNG")->required();
    app.add_option("B", command.second, "What it should look like, PNG")->required();
    app.add_option("--mask", command.mask, "White where the object is, PNG")->option_text("PNG");
    app.add_option("--background", background, "#rrggbb or a name (white, black, grey, sky ...)")
        ->option_text("COLOUR");
    app.add_option("--erode", command.options.erosion, "Inside: so many pixels from the object's border, 0 to 16")
        ->check(CLI::Range(0.0, 16.0))
        ->capture_default_str();
    app.add_option("--diff", command.diff, "Write the absolute difference, brightened, as a picture")
        ->option_text("PNG");
    app.add_option("--gain", command.gain, "By how much --diff is brightened, 1 to 255")
        ->check(CLI::Range(1, 255))
        ->capture_default_str();
    app.add_option("--json", command.json, "Write all figures to this file")->option_text("FILE");
    app.add_option("--min-psnr", command.limits.min_psnr, "Least PSNR over the frame, dB, 0 to 200")
        ->check(CLI::Range(0.0, 200.0));
    app.add_option("--min-inside", command.limits.min_inside_psnr, "Least PSNR inside the object, dB, 0 to 200")
        ->check(CLI::Range(0.0, 200.0));
    app.add_option("--min-iou", command.limits.min_iou, "Least intersection over union of the objects, 0 to 1")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--max-difference", command.limits.max_difference, "Largest difference of a channel, 0 to 255")
        ->check(CLI::Range(0, 255));
    app.add_option("--max-differing", command.limits.max_differing, "Most pixels that may differ");
    if (!parse_command_line(app, argc, argv)) return std::nullopt;
    if (!background.empty()) {
        command.options.background = parse_colour(background);
        if (!command.options.background)
            throw UsageError("--background: expected a colour like \"#ff8000\" or a name, got \"" + background + "\"");
    }
    return command;
}

bool run_compare(const CompareCommand& command) {
    check_files(command);
    const Picture first = read_png(command.first), second = read_png(command.second);
    std::optional<Picture> mask;
    if (command.mask) mask = read_png(*command.mask);
    const PictureComparison comparison =
        compare_pictures(first, second, mask ? &*mask : nullptr, command.options,
                         {command.first.string(), command.second.string(), command.mask.value_or("").string()});
    const std::vector<std::string> broken = broken_limits(comparison, command.limits);
    if (command.diff) write_difference(command, comparison);
    if (command.json) write_text_file(*command.json, comparison_json(comparison, broken));
    std::cout << comparison_text(comparison) << std::flush;
    for (const std::string& line : broken)
        std::cerr << "splice-compare: " << line << '\n';
    return broken.empty();
}

}  // namespace splice
