// splice-compare A.png B.png: how far two pictures differ.
#include "engine/compare/compare_command.h"
#include "preprocess/build_model/program_main.h"

int main(int argc, char** argv) {
    return splice::run_program("splice-compare", [&] {
        const auto command = splice::parse_compare_command(argc, argv);
        return !command || splice::run_compare(*command) ? 0 : splice::kExitFailure;
    });
}
