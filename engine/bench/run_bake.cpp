#include "engine/bench/run_bake.h"

#include "preprocess/model_format/error.h"

#include <spawn.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace splice::bench {
namespace {
namespace fs = std::filesystem;

/// Waits for it; its messages go where ours go. Throws SystemError unless it exits with 0.
void run(const std::vector<std::string>& command) {
    std::vector<char*> argv;
    for (const std::string& word : command)
        argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_t child = 0;
    if (const int error = posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ))
        throw SystemError(command[0] + ": " + std::system_category().message(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw SystemError(command[0] + ": cannot wait for it");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw SystemError(command[0] + " failed on " + command[1]);
}

// Of all children that have ended.
double processor_seconds() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

ScratchFolder::ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "splice-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw SystemError("cannot create a temporary folder like " + pattern);
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

BakeRun run_bake(const fs::path& input, const std::vector<std::string>& arguments) {
    const ScratchFolder scratch;
    const fs::path stats = scratch.path() / "stats.json";
    std::vector<std::string> command{(fs::read_symlink("/proc/self/exe").parent_path() / "splice-bake").string(),
                                     input.string(),
                                     "-o",
                                     (scratch.path() / "model.splice").string(),
                                     "--stats",
                                     stats.string(),
                                     "--quiet"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const double before = processor_seconds();
    run(command);
    std::ifstream file(stats);
    return {nlohmann::json::parse(file), processor_seconds() - before};
}

}  // namespace splice::bench
