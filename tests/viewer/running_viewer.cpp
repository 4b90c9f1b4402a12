#include "tests/viewer/running_viewer.h"

#include "preprocess/mesh/shapes.h"
#include "preprocess/mesh/write_mesh.h"
#include "tests/cli/spawn.h"

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace splice::test {

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

void write_mesh_file(const std::filesystem::path& path, std::uint32_t segments) {
    write_ply(shapes::torus_knot(2, 3, segments, 12), path);
}

void write_model_file(const std::filesystem::path& mesh, const std::filesystem::path& model) {
    const Outcome baked =
        run({program("splice-bake"), {mesh.string(), "-o", model.string(), "--triangle-share", "0.4", "--quiet"}});
    REQUIRE(baked.exit_code == 0);
}

Picture captured_by(const std::filesystem::path& folder, const std::string& line) {
    REQUIRE(line.starts_with("splice-capture "));
    const std::string path = program("splice-capture").parent_path().string();
    const Outcome outcome =
        run({"/bin/sh", {"-c", "PATH='" + path + "':$PATH; " + line.substr(0, line.find('\n')) + " --quiet"}, folder});
    INFO(line << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return read_png(folder / "capture.png");
}

RunningViewer::RunningViewer(const std::filesystem::path& folder, const std::string& display,
                             std::vector<std::string> arguments)
    : folder_(folder) {
    arguments.insert(arguments.begin(), program("splice-view").string());
    std::vector<std::string> variables =
        changed_environment({"DISPLAY=" + display, "XDG_CONFIG_HOME=" + folder.string(), "WAYLAND_DISPLAY"});
    const std::vector<char*> words = pointers_to(arguments), environment = pointers_to(variables);
    // open(2)'s header declares splice(2), which clashes with the namespace.
    std::FILE* const out = std::fopen((folder / "out.txt").c_str(), "w");
    std::FILE* const err = std::fopen((folder / "err.txt").c_str(), "w");
    REQUIRE((out != nullptr && err != nullptr));
    process_ = fork();
    if (process_ == 0) {
        // Between fork and exec only what the child of a process with several threads may do.
        if (chdir(folder_.c_str()) != 0) _exit(126);
        if (dup2(fileno(out), STDOUT_FILENO) < 0 || dup2(fileno(err), STDERR_FILENO) < 0) _exit(126);
        execve(words[0], words.data(), environment.data());
        _exit(127);
    }
    std::fclose(out);
    std::fclose(err);
}

RunningViewer::~RunningViewer() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
}

int RunningViewer::wait(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 20); ++i) {
        int status = 0;
        if (waitpid(process_, &status, WNOHANG) == process_) {
            process_ = -1;
            return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        }
        usleep(50000);
    }
    return -1;
}

Stage::Stage(std::uint32_t segments) : display(VirtualDisplay::start()) {
    if (display) write_mesh_file(folder / "knot.ply", segments);
}

void Stage::wait_for(const std::string& file) const {
    REQUIRE(display->find_window());
    REQUIRE(display->wait_for_title(file + " - splice-view"));
}

Stage::Run Stage::run_script(const std::string& script, const std::string& size,
                             const std::vector<std::string>& inputs) const {
    write_text(folder / "script.txt", script);
    std::vector<std::string> arguments = inputs;
    for (const char* option : {"--device", "cpu", "--validate", "--size", size.c_str(), "--script", "script.txt"})
        arguments.emplace_back(option);
    RunningViewer viewer(folder.path(), display->name(), arguments);
    const int code = viewer.wait();
    return {code, viewer.err()};
}

Picture scene_part(const Picture& window) {
    return cropped(window, kPanel, 0, window.width - kPanel, window.height - kStatus);
}

}  // namespace splice::test
