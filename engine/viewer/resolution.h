// Which resolution the picture is drawn at while the camera moves, so that the window keeps its pace. Pure.
#pragma once

namespace splice {

class MovingResolution {
  public:
    /// Frames should take no longer.
    static constexpr double kTargetMs = 1000.0 / 40;

    /// Share of each side, 1/2 to 1.
    double share() const;
    /// What a frame of the present share took. Coarser at once, finer only after several fast frames.
    void took(double ms);

  private:
    int step_ = 0;
    int fast_frames_ = 0;
};

}  // namespace splice
