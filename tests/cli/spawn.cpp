#include "tests/cli/spawn.h"

#include <poll.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace splice::test {
namespace {

struct Channel {
    int read_end = -1, write_end = -1;
};

Channel open_pipe() {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("pipe failed");
    return {ends[0], ends[1]};
}

// open(2)'s header declares splice(2), which clashes with the namespace; a stdio stream opens the terminal as well.
Channel open_terminal() {
    const int controller = getpt();
    if (controller < 0 || grantpt(controller) != 0 || unlockpt(controller) != 0)
        throw std::runtime_error("no terminal");
    std::array<char, 256> name{};
    ptsname_r(controller, name.data(), name.size());
    FILE* terminal = std::fopen(name.data(), "r+");
    if (!terminal) throw std::runtime_error("no terminal");
    const int descriptor = dup(fileno(terminal));
    std::fclose(terminal);
    return {controller, descriptor};
}

void read_all(Channel out, Channel err, Outcome& outcome) {
    std::array<pollfd, 2> streams = {pollfd{out.read_end, POLLIN, 0}, pollfd{err.read_end, POLLIN, 0}};
    std::array<std::string*, 2> texts = {&outcome.out, &outcome.err};
    while (std::ranges::any_of(streams, [](const pollfd& stream) { return stream.fd >= 0; })) {
        poll(streams.data(), streams.size(), -1);
        for (std::size_t i = 0; i < streams.size(); ++i) {
            if (streams[i].revents == 0) continue;
            std::array<char, 4096> buffer;
            const ssize_t count = read(streams[i].fd, buffer.data(), buffer.size());
            if (count > 0)
                texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
            else
                streams[i].fd = -1;
        }
    }
}

// In the child: nothing is allocated here, as another thread may have held the allocator's lock when it was forked.
[[noreturn]] void become(const Spawn& spawn, char* const* arguments, char* const* environment, Channel out,
                         Channel err) {
    dup2(out.write_end, STDOUT_FILENO);
    dup2(err.write_end, STDERR_FILENO);
    for (const int descriptor : {out.read_end, out.write_end, err.read_end, err.write_end})
        close(descriptor);
    if (!spawn.folder.empty() && chdir(spawn.folder.c_str()) != 0) _exit(126);
    if (spawn.in_child) spawn.in_child();
    execvpe(spawn.program.c_str(), arguments, environment);
    _exit(127);
}

}  // namespace

std::vector<std::string> changed_environment(const std::vector<std::string>& changes) {
    const auto name_of = [](const std::string& variable) { return variable.substr(0, variable.find('=')); };
    std::vector<std::string> variables;
    for (const std::string& change : changes)
        if (change.find('=') != std::string::npos) variables.push_back(change);
    for (char** variable = environ; *variable != nullptr; ++variable)
        if (std::ranges::none_of(changes,
                                 [&](const std::string& change) { return name_of(change) == name_of(*variable); }))
            variables.emplace_back(*variable);
    return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

Outcome run(const Spawn& spawn) {
    const Channel out = open_pipe();
    const Channel err = spawn.stderr_is_terminal ? open_terminal() : open_pipe();
    std::vector<std::string> words = spawn.arguments, variables = changed_environment(spawn.environment);
    words.insert(words.begin(), spawn.program.string());
    const std::vector<char*> arguments = pointers_to(words), environment = pointers_to(variables);
    const pid_t process = fork();
    if (process < 0) throw std::runtime_error("fork failed");
    if (process == 0) become(spawn, arguments.data(), environment.data(), out, err);
    close(out.write_end);
    close(err.write_end);
    if (spawn.while_it_runs) spawn.while_it_runs(process);
    Outcome outcome;
    read_all(out, err, outcome);
    close(out.read_end);
    close(err.read_end);
    int status = 0;
    waitpid(process, &status, 0);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    return outcome;
}

std::size_t line_count(const std::string& text) {
    const auto ends = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    return text.empty() || text.back() == '\n' ? ends : ends + 1;
}

}  // namespace splice::test
