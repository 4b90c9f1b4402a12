// Output files that exist whole or not at all.
#pragma once

#include "preprocess/model_format/signal_cleanup.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace splice {

/// A file that appears under its name only when commit() returns. It is written to an unnamed file in the same folder
/// (O_TMPFILE), which the kernel frees whatever ends the process. Where the file system has no unnamed files, to a
/// hidden file beside it, removed on failure and by SIGINT, SIGTERM and SIGHUP; an unnamed file that replaces an
/// existing one passes through such a name, too, for the time of two system calls. Replaces only regular files (never a
/// device); a symbolic link is followed. One writer at a time in a process.
class AtomicFile {
  public:
    enum class Storage { kUnnamedIfPossible, kNamed };
    explicit AtomicFile(std::filesystem::path path,
                        Storage storage = Storage::kUnnamedIfPossible);  // throws SystemError
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);  // throws SystemError
    void commit();  // flushes to the disk and gives the file its name; throws SystemError

  private:
    void open_named();
    void name_unnamed();
    void adopt_temporary_name(const std::filesystem::path& name);
    void forget_temporary_name();

    std::filesystem::path path_;
    std::filesystem::path temporary_;       // empty while the file has no name
    std::optional<SignalCleanup> cleanup_;  // for temporary_
    int descriptor_ = -1;
};

/// Throws SystemError when a file could not be created at `path` (missing folder, no permission, something that is not
/// a regular file in the way): asked before long work.
void check_output_path(const std::filesystem::path& path);

void write_text_file(const std::filesystem::path& path, std::string_view text);  // throws SystemError

}  // namespace splice
