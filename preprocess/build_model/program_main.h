// What the programs' main() functions share: exceptions become one line on stderr and an exit code.
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace splice {

inline constexpr int kExitFailure = 1;  // input, system, memory
inline constexpr int kExitUsage = 2;

/// Runs `body` and returns its result; an exception is printed as "PROGRAM: MESSAGE" and becomes an exit code, and
/// so does standard output that did not arrive. Writing beyond a file size limit becomes an error of that write instead
/// of a signal.
int run_program(const std::string& program, const std::function<int()>& body);

/// Parses the command line. False when --help or --version was asked for and printed. Throws UsageError.
bool parse_command_line(CLI::App& app, int argc, const char* const* argv);

}  // namespace splice
