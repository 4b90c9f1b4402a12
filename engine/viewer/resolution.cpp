#include "engine/viewer/resolution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace splice {

namespace {

constexpr std::array kShares{1.0, 0.75, 0.5};
constexpr int kLast = static_cast<int>(kShares.size()) - 1;
constexpr int kSoon = 3;                           // frames in which a finer step shows whether it was too fine
constexpr int kMostPatience = 80;                  // frames
constexpr double kFinest = 1;                      // tau, above 0
constexpr double kMostCoarser = 2, kFiner = 0.84;  // times tau, a step
constexpr double kSpare = 0.85;                    // of the target: a frame that leaves room

}  // namespace

double MovingDetail::share() const {
    return kShares[static_cast<std::size_t>(step_)];
}

void MovingDetail::took(double ms, double target_ms, double most_tau) {
    tau_ = std::min(tau_, most_tau);
    const double last_ms = std::exchange(last_ms_, ms);
    ++frames_since_finer_;
    if (ms > target_ms) {
        fast_frames_ = 0;
        if (!was_too_fine_ && frames_since_finer_ <= kSoon) {
            was_too_fine_ = true;
            patience_ = std::min(2 * patience_, kMostPatience);
        }
        if (step_ < kLast) {
            ++step_;
        } else if (last_ms > target_ms && most_tau > 0) {
            // What is drawn goes with the square of tau, and with part of the time.
            const double factor = std::clamp(std::min(ms, last_ms) / target_ms, 1.1, kMostCoarser);
            tau_ = std::min(tau_ == 0 ? kFinest : tau_ * factor, std::min(most_tau, kCoarsest));
        }
        return;
    }
    if (tau_ > 0) {
        fast_frames_ = ms < kSpare * target_ms ? fast_frames_ + 1 : 0;
        if (fast_frames_ < patience_) return;
        begin_finer();
        tau_ *= kFiner;
        if (tau_ < kFinest) tau_ = 0;
        return;
    }
    if (step_ == 0) return;
    // The time goes with the pixels at most, so the finer step fits if that much more does.
    const double finer = kShares[static_cast<std::size_t>(step_ - 1)] / share();
    fast_frames_ = ms * finer * finer < target_ms ? fast_frames_ + 1 : 0;
    if (fast_frames_ < patience_) return;
    begin_finer();
    --step_;
}

void MovingDetail::begin_finer() {
    if (!was_too_fine_) patience_ = kPatience;
    was_too_fine_ = false;
    frames_since_finer_ = fast_frames_ = 0;
}

}  // namespace splice
