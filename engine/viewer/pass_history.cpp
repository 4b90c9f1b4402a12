#include "engine/viewer/pass_history.h"

#include <algorithm>

namespace splice {

void PassHistory::add(const std::vector<PassTime>& passes) {
    for (Series& series : series_)
        series.ms[next_] = series.last = 0;
    for (const PassTime& pass : passes) {
        auto found = std::find_if(series_.begin(), series_.end(),
                                  [&](const Series& series) { return series.name == pass.name; });
        if (found == series_.end()) {
            series_.push_back({.name = pass.name});
            found = series_.end() - 1;
        }
        found->ms[next_] += static_cast<float>(pass.gpu_ms);
        found->last = found->ms[next_];
    }
    // Passes that no frame of the ring has, such as another backend's, are forgotten.
    std::erase_if(series_, [](const Series& series) {
        return std::all_of(series.ms.begin(), series.ms.end(), [](float ms) { return ms == 0; });
    });
    next_ = (next_ + 1) % kFrames;
}

}  // namespace splice
