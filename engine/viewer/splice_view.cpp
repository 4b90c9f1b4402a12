// splice-view [INPUT...]: a window on hybrid models.
#include "engine/viewer/viewer.h"
#include "engine/viewer/viewer_command_line.h"
#include "preprocess/build_model/program_main.h"

#include <iostream>

int main(int argc, char** argv) {
    using namespace splice;
    return run_program("splice-view", [&] {
        const auto command = parse_viewer_command_line(argc, argv);
        if (!command) return 0;
        if (command->list_devices) {
            for (const std::string& line : list_devices())
                std::cout << line << '\n';
            return 0;
        }
        Viewer viewer(*command);
        return viewer.run() ? 0 : 1;
    });
}
