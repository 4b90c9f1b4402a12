#include "preprocess/build_model/program_main.h"

#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <new>
#include <system_error>

namespace splice {
namespace {

// File names and messages of other libraries may hold line ends and control characters.
std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text;
}

int report(const std::string& program, const std::string& message, int exit_code) {
    std::cerr << one_line(program + ": " + message) << std::endl;
    return exit_code;
}

// A full disk behind stdout shows when the last of the buffers is written, or earlier: then the streams remember.
void flush_output() {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return;
    throw SystemError(std::string("cannot write to standard output") +
                      (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

// "--quiet=3" is a slip, not a flag.
void refuse_flag_values(CLI::App& app) {
    for (CLI::Option* option : app.get_options())
        if (option->get_expected_max() == 0) option->disable_flag_override();
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        refuse_flag_values(*command);
}

// Ranges let NaN through, which compares with nothing, and options without a range infinity, too.
std::string check_finite(const std::string& text) {
    return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : "'" + text + "' is not a finite number";
}

// CLI11 names the type of floating-point options so, unless they are given another name.
void refuse_infinite_numbers(CLI::App& app) {
    for (CLI::Option* option : app.get_options())
        if (option->get_type_name().starts_with("FLOAT")) option->check(check_finite);
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        refuse_infinite_numbers(*command);
}

}  // namespace

int run_program(const std::string& program, const std::function<int()>& body) {
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        const int exit_code = body();
        flush_output();
        return exit_code;
    } catch (const UsageError& error) {
        return report(program, error.what(), kExitUsage);
    } catch (const Error& error) {
        return report(program, error.what(), kExitFailure);
    } catch (const std::bad_alloc&) {
        return report(program, "out of memory", kExitFailure);
    } catch (const std::system_error& error) {
        return report(program, error.what(), kExitFailure);
    } catch (const std::exception& error) {
        return report(program, std::string("internal error: ") + error.what(), kExitFailure);
    }
}

bool parse_command_line(CLI::App& app, int argc, const char* const* argv) {
    refuse_flag_values(app);
    refuse_infinite_numbers(app);
    try {
        app.parse(argc, argv);
        return true;
    } catch (const CLI::CallForHelp&) {
        std::cout << app.help();
    } catch (const CLI::CallForVersion&) {
        std::cout << app.version() << '\n';
    } catch (const CLI::ParseError& error) {
        throw UsageError(std::string(error.what()) + " (see --help)");
    }
    return false;
}

}  // namespace splice
