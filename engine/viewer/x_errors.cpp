#include "engine/viewer/x_errors.h"

#include <X11/Xlib.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace splice {

namespace {

int take_error(Display* display, XErrorEvent* error) {
    if (error->error_code == BadWindow || error->error_code == BadDrawable) return 0;
    std::array<char, 256> text{};
    XGetErrorText(display, error->error_code, text.data(), static_cast<int>(text.size()));
    std::fprintf(stderr, "splice-view: the X server refused request %d: %s\n", error->request_code, text.data());
    std::exit(1);  // as Xlib's own handler
}

}  // namespace

void ignore_missing_windows() {
    XSetErrorHandler(take_error);
}

}  // namespace splice
