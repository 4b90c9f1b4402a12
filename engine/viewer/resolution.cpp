#include "engine/viewer/resolution.h"

#include <array>

namespace splice {

namespace {

constexpr std::array kShares{1.0, 0.75, 0.5};
constexpr int kLast = static_cast<int>(kShares.size()) - 1;
constexpr int kPatience = 10;  // frames

}  // namespace

double MovingResolution::share() const {
    return kShares[static_cast<std::size_t>(step_)];
}

void MovingResolution::took(double ms) {
    if (ms > kTargetMs) {
        fast_frames_ = 0;
        if (step_ < kLast) ++step_;
        return;
    }
    if (step_ == 0) return;
    // The time goes with the pixels at most, so the finer step fits if that much more does.
    const double finer = kShares[static_cast<std::size_t>(step_ - 1)] / share();
    fast_frames_ = ms * finer * finer < kTargetMs ? fast_frames_ + 1 : 0;
    if (fast_frames_ < kPatience) return;
    fast_frames_ = 0;
    --step_;
}

}  // namespace splice
