// Shows on stderr which stage runs: a progress bar on a terminal, and one line a finished stage. A stage's line waits
// for the next to end: input that is read well and refused by the stage after gets one line, the error's.
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
    void finish();  // ends the current stage, the last

  private:
    void end_stage();
    void write_ended() const;
    double elapsed_seconds() const;
    void draw_bar(double fraction) const;
    void erase_bar() const;

    bool quiet_;
    bool terminal_;
    std::string stage_;
    std::string ended_;  // the line of the stage before, not written yet
    std::chrono::steady_clock::time_point start_;
};

}  // namespace splice
