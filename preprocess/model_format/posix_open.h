// The few calls that need <fcntl.h>. That header declares splice(2), which cannot share a translation unit with our
// namespace of the same name, so posix_open.cpp is the one file that includes it and stays outside the namespace.
#pragma once

namespace posix_open {

/// Descriptor of the file for reading, or -1 with errno set. Does not wait for a writer when the path is a pipe.
int open_for_reading(const char* path);

/// Descriptor of a new file without a name in `folder` (O_TMPFILE) for writing, or -1 with errno set.
int open_unnamed(const char* folder);

/// Gives such a file the name `path`, which must not exist; false with errno set on failure.
bool link_unnamed(int descriptor, const char* path);

}  // namespace posix_open
