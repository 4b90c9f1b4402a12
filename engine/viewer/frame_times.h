// What frames of the window took. Pure.
#pragma once

#include <cstddef>
#include <vector>

namespace splice {

class FrameTimes {
  public:
    /// The last so many are kept.
    static constexpr std::size_t kMost = 1024;

    void add(double ms);
    void clear();
    std::size_t count() const { return ms_.size(); }
    /// 0 without frames.
    double median_ms() const;
    double frames_per_second() const;

  private:
    std::vector<double> ms_;  // a ring
    std::size_t next_ = 0;
};

}  // namespace splice
