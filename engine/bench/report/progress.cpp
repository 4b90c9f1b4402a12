#include "engine/bench/report/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace splice::bench {

void show_progress(std::string_view text) {
    if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K{}", text);
}

}  // namespace splice::bench
