// Telling the user how far a benchmark is.
#pragma once

#include <string_view>

namespace splice::bench {

/// Tells the terminal what is going on; an empty text wipes the line. Nothing where stderr is no terminal.
void show_progress(std::string_view text);

}  // namespace splice::bench
