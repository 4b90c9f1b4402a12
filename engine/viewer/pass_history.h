// Times of passes over the last frames, for the plot.
#pragma once

#include "engine/capture/capture.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace splice {

class PassHistory {
  public:
    static constexpr std::size_t kFrames = 120;

    struct Series {
        std::string name;
        std::array<float, kFrames> ms{};  // a ring; frames without the pass are 0
        float last = 0;
    };

    void add(const std::vector<PassTime>& passes);
    /// In the order in which passes were first seen.
    const std::vector<Series>& series() const { return series_; }
    /// Index of the oldest frame in each ring.
    std::size_t oldest() const { return next_; }

  private:
    std::vector<Series> series_;
    std::size_t next_ = 0;
};

}  // namespace splice
