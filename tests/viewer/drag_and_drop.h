// The sending side of X's drag and drop (XDND, freedesktop.org, version 5), as a file manager plays it.
#pragma once

#include <X11/Xlib.h>

#include <string>

namespace splice::test {

/// Drops one file, named by its URI, on a window at a place of the screen. True if the window said that it took it.
bool drop_file(Display* display, Window target, const std::string& uri, int root_x, int root_y);

}  // namespace splice::test
