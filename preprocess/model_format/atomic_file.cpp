#include "preprocess/model_format/atomic_file.h"

#include "preprocess/model_format/error.h"
#include "preprocess/model_format/posix_open.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
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

mode_t default_mode() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

}  // namespace

AtomicFile::AtomicFile(fs::path path, Storage storage) : path_(std::move(path)) {
    check_output_path(path_);
    std::error_code error;
    if (fs::is_symlink(path_, error) && fs::exists(path_, error)) path_ = fs::canonical(path_);
    if (storage == Storage::kUnnamedIfPossible) {
        descriptor_ = posix_open::open_unnamed(folder_of(path_).c_str());
        if (descriptor_ >= 0) return;
        if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) fail(path_, "cannot create", errno);
    }
    open_named();
}

void AtomicFile::open_named() {
    std::string pattern = (folder_of(path_) / ("." + path_.filename().string() + ".XXXXXX")).string();
    descriptor_ = mkstemp(pattern.data());
    if (descriptor_ < 0) fail(path_, "cannot create", errno);
    adopt_temporary_name(pattern);
    if (fchmod(descriptor_, default_mode()) != 0) fail(path_, "cannot create", errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (temporary_.empty()) return;
    unlink(temporary_.c_str());
    forget_temporary_name();
}

void AtomicFile::adopt_temporary_name(const fs::path& name) {
    cleanup_.emplace(name);
    temporary_ = name;
}

void AtomicFile::forget_temporary_name() {
    temporary_.clear();
    cleanup_.reset();
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
        const std::string unique = std::to_string(getpid()) + "." + std::to_string(attempt);
        adopt_temporary_name(folder_of(path_) / ("." + path_.filename().string() + "." + unique));
        if (link_as(temporary_)) return;
        const int error = errno;
        forget_temporary_name();
        if (error != EEXIST) fail(path_, "cannot create", error);
    }
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) fail(path_, "cannot write", errno);
    if (temporary_.empty()) name_unnamed();
    if (!temporary_.empty()) {
        if (rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "cannot create", errno);
        forget_temporary_name();
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
