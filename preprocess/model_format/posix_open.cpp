#include "preprocess/model_format/posix_open.h"

#include <fcntl.h>
#include <unistd.h>

#include <string>

namespace posix_open {

int open_for_reading(const char* path) {
    return open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

int open_unnamed(const char* folder) {
    return open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
}

bool link_unnamed(int descriptor, const char* path) {
    const std::string source = "/proc/self/fd/" + std::to_string(descriptor);
    return linkat(AT_FDCWD, source.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace posix_open
