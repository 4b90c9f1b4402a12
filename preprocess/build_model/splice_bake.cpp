// splice-bake INPUT -o MODEL.splice: a mesh file becomes a model file.
#include "preprocess/build_model/bake_command_line.h"
#include "preprocess/build_model/bake_report.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/build_model/stage_display.h"
#include "preprocess/large_vector.h"
#include "preprocess/model_format/atomic_file.h"

#include <sys/resource.h>

#include <chrono>
#include <iostream>

namespace {

using namespace splice;

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

BakeResult write(const Model& model, const std::filesystem::path& path, bool compress) {
    BakeResult result;
    const auto start = std::chrono::steady_clock::now();
    result.file_bytes = compress ? write_compressed_model(view_of(model), path) : write_model(view_of(model), path);
    result.seconds_write = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.drawn_triangles = model.info.drawn_triangles;
    result.surfels = view_of(model).surfel_count();
    result.peak_rss_bytes = peak_rss_bytes();
    return result;
}

int bake(const BakeCommand& command) {
    check_output_path(command.output);
    if (command.stats) check_output_path(*command.stats);

    BakeStats stats;
    BakeResult result;
    {
        StageDisplay display(command.quiet);
        const auto progress = [&](std::string_view stage, double fraction) { display.update(stage, fraction); };
        const Model model = bake_file(command.input, command.options, stats, progress);
        check_files(command, stats.companions);
        display.update("write", 0);
        result = write(model, command.output, command.compress);
        display.finish();
    }
    if (command.stats) write_text_file(*command.stats, stats_json(stats, result));
    if (command.quiet) return 0;
    for (const std::string& warning : stats.warnings)
        std::cerr << "splice-bake: warning: " << warning << '\n';
    std::cout << summary(stats, result) << "wrote    " << command.output.string() << std::endl;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    splice::keep_freed_memory();
    return run_program("splice-bake", [&] {
        const auto command = parse_bake_command(argc, argv);
        return command ? bake(*command) : 0;
    });
}
