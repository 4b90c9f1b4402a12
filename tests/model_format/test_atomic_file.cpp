#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

using namespace splice;
using Storage = AtomicFile::Storage;

namespace {

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string content(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The signal that ended a new process running `body`, 0 when none did.
int signal_that_ended(const std::function<void()>& body) {
    const pid_t process = fork();
    if (process == 0) {
        body();
        _exit(0);
    }
    int status = 0;
    waitpid(process, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

TEST_CASE("a file appears when it is committed, and not before") {
    for (const Storage storage : {Storage::kUnnamedIfPossible, Storage::kNamed}) {
        const test::TemporaryFolder folder;
        for (const char* text : {"first", "second, which replaces the first"}) {
            AtomicFile file(folder / "out", storage);
            const std::string before = content(folder / "out");
            file.write(bytes_of(text));
            CHECK(content(folder / "out") == before);
            file.commit();
            CHECK(content(folder / "out") == text);
            CHECK(files_in(folder.path()) == 1);
        }
        struct stat status {};
        REQUIRE(stat((folder / "out").c_str(), &status) == 0);
        const mode_t mask = umask(0);
        umask(mask);
        CHECK((status.st_mode & 0777) == (0666 & ~mask));
    }
}

TEST_CASE("a file that is not committed leaves nothing") {
    for (const Storage storage : {Storage::kUnnamedIfPossible, Storage::kNamed}) {
        const test::TemporaryFolder folder;
        {
            AtomicFile file(folder / "out", storage);
            file.write(bytes_of("half of it"));
        }
        CHECK(files_in(folder.path()) == 0);
    }
}

TEST_CASE("a process ended by a signal leaves nothing") {
    for (const Storage storage : {Storage::kUnnamedIfPossible, Storage::kNamed}) {
        for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
            const test::TemporaryFolder folder;
            const int ended_by = signal_that_ended([&] {
                std::signal(signal_number, SIG_DFL);
                AtomicFile file(folder / "out", storage);
                file.write(bytes_of("half of it"));
                std::raise(signal_number);
            });
            CHECK(ended_by == signal_number);
            CHECK(files_in(folder.path()) == 0);
        }
    }
}

TEST_CASE("an unnamed file needs no signal handler to vanish") {
    const test::TemporaryFolder folder;
    CHECK(signal_that_ended([&] {
              AtomicFile file(folder / "out");
              file.write(bytes_of("half of it"));
              std::raise(SIGKILL);
          }) == SIGKILL);
    CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("ignored signals stay ignored, and later signals end the process as ever") {
    const test::TemporaryFolder folder;
    CHECK(signal_that_ended([&] {
              std::signal(SIGHUP, SIG_IGN);
              AtomicFile file(folder / "out", Storage::kNamed);
              std::raise(SIGHUP);
              file.commit();
          }) == 0);
    CHECK(files_in(folder.path()) == 1);
    CHECK(signal_that_ended([&] {
              std::signal(SIGTERM, SIG_DFL);
              AtomicFile(folder / "other", Storage::kNamed).commit();
              std::raise(SIGTERM);
          }) == SIGTERM);
    CHECK(files_in(folder.path()) == 2);
}

TEST_CASE("text files are written whole") {
    const test::TemporaryFolder folder;
    write_text_file(folder / "text", "some text\n");
    CHECK(content(folder / "text") == "some text\n");
    CHECK_THROWS_AS(write_text_file(folder / "absent/text", "some text\n"), SystemError);
}
