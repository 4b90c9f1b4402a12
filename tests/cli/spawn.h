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
    std::filesystem::path folder = {};    // to run in; empty: where the test runs
    std::function<void()> in_child = {};  // called in the new process before the program starts
    std::function<void(int process)> while_it_runs = {};
    bool stderr_is_terminal = false;
};
Outcome run(const Spawn& spawn);

/// Lines in `text`, the last one without an end included.
std::size_t line_count(const std::string& text);

}  // namespace splice::test
