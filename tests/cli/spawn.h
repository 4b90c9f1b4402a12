// Runs a program as a user would, and sees what it prints and leaves.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace splice::test {

struct Outcome {
    int exit_code = -1;  // -1 when a signal ended it
    int signal = 0;
    std::string out, err;
};

struct Spawn {
    std::filesystem::path program;
    std::vector<std::string> arguments = {};
    std::filesystem::path folder = {};          // to run in; empty: where the test runs
    std::vector<std::string> environment = {};  // NAME=VALUE: in place of what the test has; NAME: not there
    // Called in the new process before the program starts: only what is safe after fork, where other threads may have
    // held locks; no setenv.
    std::function<void()> in_child = {};
    std::function<void(int process)> while_it_runs = {};
    bool stderr_is_terminal = false;
};
Outcome run(const Spawn& spawn);

/// The test's own environment with changes as Spawn::environment says them.
std::vector<std::string> changed_environment(const std::vector<std::string>& changes);
/// For exec, with its end; `words` must stay.
std::vector<char*> pointers_to(std::vector<std::string>& words);

/// Lines in `text`, the last one without an end included.
std::size_t line_count(const std::string& text);

}  // namespace splice::test
