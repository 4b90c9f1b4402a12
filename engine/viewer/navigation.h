// Which movement of the hand moves the camera how (docs/viewer.md). Pure: events and seconds in, a moved camera out.
#pragma once

#include "engine/viewer/camera_controller.h"
#include "engine/viewer/input.h"

#include <functional>
#include <optional>
#include <set>

namespace splice {

/// Where the picture is in the window, pixels; cursor positions of events are multiplied by `scale` first.
struct PictureArea {
    double x = 0, y = 0;
    Viewport size;
    double scale = 1;
    /// An event's position in the picture.
    glm::dvec2 inside(double window_x, double window_y) const { return {window_x * scale - x, window_y * scale - y}; }
};

class Navigation {
  public:
    /// The surface point seen at a place of the picture.
    using Surface = std::function<std::optional<glm::dvec3>(const glm::dvec2&)>;

    OrbitStyle style = OrbitStyle::kTurntable;

    /// Moves the camera as an event over the picture says. True if the event meant something.
    bool handle(const InputEvent& event, const PictureArea& area, CameraController& camera, const Surface& surface);
    /// Flies while the right button and keys are held. True while it does.
    bool advance(double seconds, CameraController& camera) const;
    /// A button went down over the picture and is still down: the events that follow are the picture's, too.
    bool dragging() const { return button_.has_value(); }
    /// The place of a click (down and up without a drag) since the last call.
    std::optional<glm::dvec2> take_click();

  private:
    /// Keys and buttons go up unseen when a window loses them.
    void release_all();
    bool press(const InputEvent& event, const PictureArea& area, CameraController& camera, const Surface& surface);
    bool move(const InputEvent& event, const PictureArea& area, CameraController& camera);
    bool key(const InputEvent& event, const PictureArea& area, CameraController& camera);

    std::optional<Button> button_;
    int modifiers_ = 0;  // when the button went down
    glm::dvec2 last_{0};
    double travelled_ = 0;  // pixels since the button went down
    double last_press_ = -1;
    glm::dvec2 last_press_at_{0};
    std::optional<glm::dvec2> click_;
    std::set<int> keys_;  // held, of those that fly
    bool fast_ = false;
};

}  // namespace splice
