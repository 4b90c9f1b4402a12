// Shows on stderr which stage runs: a progress bar on a terminal, one line a finished stage otherwise.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace splice {

class StageDisplay {
  public:
    explicit StageDisplay(bool quiet);
    ~StageDisplay();
    StageDisplay(const StageDisplay&) = delete;
    StageDisplay& operator=(const StageDisplay&) = delete;

    /// As splice::Progress.
    void update(std::string_view stage, double fraction);
    void finish();  // ends the current stage

  private:
    double elapsed_seconds() const;
    void draw_bar(double fraction) const;
    void erase_bar() const;

    bool quiet_;
    bool terminal_;
    std::string stage_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace splice
