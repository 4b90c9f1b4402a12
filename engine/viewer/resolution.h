// How the picture is drawn while the camera moves, so that the window keeps its pace: at which resolution, and with
// which level of detail. Pure.
#pragma once

namespace splice {

class MovingDetail {
  public:
    /// Frames should take no longer, by default.
    static constexpr double kTargetMs = 1000.0 / 40;

    /// Share of each side, 1/2 to 1.
    double share() const;
    /// Pixels of the picture as it is drawn (engine/scene/lod_cut.h), 0 to kCoarsest; 0: full detail.
    double tau() const { return tau_; }
    /// What a frame of the present detail took. Coarser at once, fewer pixels first, though levels of detail only where
    /// the frame before was slow, too: one may have waited for a shader. Finer only after several fast frames, levels
    /// of detail first; each time that the finer frame turns out slow, after twice as many.
    /// `most_tau` bounds tau: 0 holds levels of detail, and only pixels become fewer.
    void took(double ms, double target_ms = kTargetMs, double most_tau = kCoarsest);

    static constexpr double kCoarsest = 32;

  private:
    void begin_finer();

    int step_ = 0;
    double tau_ = 0;
    double last_ms_ = 0;
    int fast_frames_ = 0;
    static constexpr int kPatience = 10;
    int patience_ = kPatience;            // fast frames before the next step to finer
    int frames_since_finer_ = kPatience;  // since the last such step
    bool was_too_fine_ = false;           // that step
};

}  // namespace splice
