// splice-info MODEL.splice: checks a model file and prints what it holds.
#include "preprocess/build_model/model_report.h"
#include "preprocess/build_model/program_main.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace {

int inform(int argc, char** argv) {
    CLI::App app{"Checks a model file and prints what it holds, section by section.", "splice-info"};
    app.footer("Exit code: 0 the model is intact, 1 it is not (the reason is printed), 2 wrong usage.");
    std::string path;
    bool json = false;
    app.add_option("MODEL", path, "Model file, as splice-bake writes it")->required();
    app.add_flag("--json", json, "Print JSON");
    app.set_version_flag("--version", "splice-info " SPLICE_VERSION);
    if (!splice::parse_command_line(app, argc, argv)) return 0;
    const splice::ModelFile file{path};
    std::cout << (json ? splice::model_report_json(file, path) : splice::model_report_text(file, path)) << std::flush;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return splice::run_program("splice-info", [&] { return inform(argc, argv); });
}
