// Output files that exist whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace splice {

/// A file that appears under its name only when commit() returns. It is written to an unnamed file in the same folder
/// (O_TMPFILE), which the kernel frees whatever ends the process. Where the file system has no unnamed files, to a
/// hidden file beside it, removed on failure and on SIGINT, SIGTERM and SIGHUP. Replaces only regular files (never a
/// device); a symbolic link is followed. One writer at a time in a process.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path path);  // throws SystemError
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);  // throws SystemError
    void commit();  // flushes to the disk and gives the file its name; throws SystemError

  private:
    void open_named();
    void name_unnamed();

    std::filesystem::path path_;
    std::filesystem::path temporary_;  // empty while the file has no name
    int descriptor_ = -1;
};

/// Throws SystemError when a file could not be created at `path` (missing folder, no permission, something that is not
/// a regular file in the way): asked before long work.
void check_output_path(const std::filesystem::path& path);

void write_text_file(const std::filesystem::path& path, std::string_view text);  // throws SystemError

}  // namespace splice
