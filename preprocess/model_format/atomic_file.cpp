#include "preprocess/model_format/atomic_file.h"

#include "preprocess/model_format/error.h"
#include "preprocess/model_format/posix_open.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>

namespace splice {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
    throw SystemError(path.string() + ": " + what + ": " + std::strerror(error));
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// A signal handler can reach nothing but statics. Set only while a named temporary file exists.
std::array<char, PATH_MAX> pending_name{};
std::atomic<bool> pending{false};
static_assert(std::atomic<bool>::is_always_lock_free);
constexpr std::array kFatalSignals = {SIGINT, SIGTERM, SIGHUP};

extern "C" void remove_pending_and_die(int signal_number) {
    if (pending.exchange(false)) unlink(pending_name.data());
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

void start_removal_on_signal(const fs::path& name) {
    const std::string text = fs::absolute(name).string();
    if (text.size() >= pending_name.size()) fail(name, "cannot create", ENAMETOOLONG);
    std::copy(text.begin(), text.end(), pending_name.begin());
    pending_name[text.size()] = '\0';
    for (const int signal_number : kFatalSignals)
        std::signal(signal_number, remove_pending_and_die);
    pending = true;
}

void stop_removal_on_signal() {
    pending = false;
    for (const int signal_number : kFatalSignals)
        std::signal(signal_number, SIG_DFL);
}

mode_t default_mode() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    check_output_path(path_);
    std::error_code error;
    if (fs::is_symlink(path_, error) && fs::exists(path_, error)) path_ = fs::canonical(path_);
    descriptor_ = posix_open::open_unnamed(folder_of(path_).c_str());
    if (descriptor_ >= 0) return;
    if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) fail(path_, "cannot create", errno);
    open_named();
}

void AtomicFile::open_named() {
    std::string pattern = (folder_of(path_) / ("." + path_.filename().string() + ".XXXXXX")).string();
    descriptor_ = mkstemp(pattern.data());
    if (descriptor_ < 0) fail(path_, "cannot create", errno);
    temporary_ = pattern;
    start_removal_on_signal(temporary_);
    fchmod(descriptor_, default_mode());
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!temporary_.empty()) {
        unlink(temporary_.c_str());
        stop_removal_on_signal();
    }
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(path_, "cannot write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

// linkat() does not replace an existing file, rename() does; so an unnamed file that must replace another takes a
// temporary name first. O_EXCL semantics of linkat choose the name.
void AtomicFile::name_unnamed() {
    const auto link_as = [&](const fs::path& name) { return posix_open::link_unnamed(descriptor_, name.c_str()); };
    if (link_as(path_)) return;
    if (errno != EEXIST) fail(path_, "cannot create", errno);
    for (unsigned attempt = 0;; ++attempt) {
        const fs::path name = folder_of(path_) / ("." + path_.filename().string() + "." + std::to_string(getpid()) +
                                                  "." + std::to_string(attempt));
        start_removal_on_signal(name);
        if (link_as(name)) {
            temporary_ = name;
            return;
        }
        const int error = errno;
        stop_removal_on_signal();
        if (error != EEXIST) fail(path_, "cannot create", error);
    }
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) fail(path_, "cannot write", errno);
    if (temporary_.empty()) name_unnamed();
    if (!temporary_.empty()) {
        if (rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "cannot create", errno);
        temporary_.clear();
        stop_removal_on_signal();
    }
    if (close(std::exchange(descriptor_, -1)) != 0) fail(path_, "cannot write", errno);
}

void check_output_path(const fs::path& path) {
    std::error_code error;
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
        throw SystemError(path.string() + ": cannot write: is not a regular file");
    const fs::path folder = folder_of(path);
    if (!fs::is_directory(folder, error))
        throw SystemError(path.string() + ": cannot write: there is no folder " + folder.string());
    if (access(folder.c_str(), W_OK | X_OK) != 0) fail(path, "cannot write into its folder", errno);
}

void write_text_file(const fs::path& path, std::string_view text) {
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(text.data(), text.size())));
    file.commit();
}

}  // namespace splice
