// What X servers answer to requests that concern a window which another program destroyed.
#pragma once

namespace splice {

/// Requests for windows that are gone fail silently from here on: Xlib would end the program in the middle, and
/// looking at the surface says the same in a way that can be handled. Any other error of the server ends it as before.
/// Holds for the process; without effect where no X server is talked to.
void ignore_missing_windows();

}  // namespace splice
