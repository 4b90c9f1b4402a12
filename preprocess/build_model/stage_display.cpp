#include "preprocess/build_model/stage_display.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace splice {

StageDisplay::StageDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

// An error in mid-stage must not be printed behind the bar.
StageDisplay::~StageDisplay() {
    if (!stage_.empty()) erase_bar();
}

void StageDisplay::update(std::string_view stage, double fraction) {
    if (quiet_) return;
    if (stage != stage_) {
        end_stage();
        stage_ = stage;
        start_ = std::chrono::steady_clock::now();
    }
    if (terminal_) draw_bar(fraction);
}

void StageDisplay::finish() {
    end_stage();
    write_ended();
    ended_.clear();
}

void StageDisplay::end_stage() {
    if (stage_.empty()) return;
    erase_bar();
    write_ended();
    std::array<char, 32> seconds{};
    std::snprintf(seconds.data(), seconds.size(), "%8.2f s\n", elapsed_seconds());
    ended_ = stage_ + std::string(stage_.size() < 9 ? 9 - stage_.size() : 0, ' ') + ' ' + seconds.data();
    stage_.clear();
}

void StageDisplay::write_ended() const {
    std::fputs(ended_.c_str(), stderr);
}

double StageDisplay::elapsed_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void StageDisplay::draw_bar(double fraction) const {
    constexpr int width = 30;
    const double shown = std::clamp(fraction, 0.0, 1.0);
    const std::string bar(static_cast<std::size_t>(shown * width), '#');
    std::fprintf(stderr, "\r%-9s [%-*s] %3.0f %%", stage_.c_str(), width, bar.c_str(), 100 * shown);
    std::fflush(stderr);
}

void StageDisplay::erase_bar() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
}

}  // namespace splice
