#include "engine/viewer/frame_times.h"

#include <algorithm>
#include <numeric>

namespace splice {

void FrameTimes::add(double ms) {
    if (ms_.size() < kMost) {
        ms_.push_back(ms);
        return;
    }
    ms_[next_] = ms;
    next_ = (next_ + 1) % kMost;
}

void FrameTimes::clear() {
    ms_.clear();
    next_ = 0;
}

double FrameTimes::median_ms() const {
    if (ms_.empty()) return 0;
    std::vector<double> sorted = ms_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

double FrameTimes::frames_per_second() const {
    const double all = std::accumulate(ms_.begin(), ms_.end(), 0.0);
    return all > 0 ? 1000 * static_cast<double>(ms_.size()) / all : 0;
}

}  // namespace splice
