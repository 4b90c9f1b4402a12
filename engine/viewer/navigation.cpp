#include "engine/viewer/navigation.h"

#include <string_view>
#include <utility>

namespace splice {

namespace {

constexpr double kDoubleClickSeconds = 0.35;
constexpr double kClickPixels = 4;  // a hand is not still
constexpr double kFast = 4;         // times, with shift
constexpr std::string_view kFlyingKeys = "WASDQE";

}  // namespace

std::optional<glm::dvec2> Navigation::take_click() {
    return std::exchange(click_, std::nullopt);
}

void Navigation::release_all() {
    button_.reset();
    keys_.clear();
}

bool Navigation::handle(const InputEvent& event, const PictureArea& area, CameraController& camera,
                        const Surface& surface) {
    switch (event.kind) {
        case InputEvent::Kind::kCursor:
            return move(event, area, camera);
        case InputEvent::Kind::kButton:
            if (event.pressed) return press(event, area, camera, surface);
            if (!button_ || static_cast<int>(*button_) != event.code) return false;
            if (*button_ == Button::kLeft && travelled_ < kClickPixels) click_ = last_;
            button_.reset();
            return true;
        case InputEvent::Kind::kWheel: {
            if (event.y == 0) return false;
            camera.zoom(event.y, last_.x, last_.y, area.size, surface(last_));
            return true;
        }
        case InputEvent::Kind::kKey:
            return key(event, area, camera);
        case InputEvent::Kind::kFocus:
            release_all();
            return true;
        case InputEvent::Kind::kText:
        case InputEvent::Kind::kDrop:
            break;
    }
    return false;
}

bool Navigation::press(const InputEvent& event, const PictureArea& area, CameraController& camera,
                       const Surface& surface) {
    if (button_ || event.code < 0 || event.code > static_cast<int>(Button::kMiddle)) return false;
    button_ = static_cast<Button>(event.code);
    modifiers_ = event.modifiers;
    travelled_ = 0;
    last_ = area.inside(event.x, event.y);
    if (*button_ != Button::kLeft) return true;
    const bool twice =
        event.time - last_press_ <= kDoubleClickSeconds && glm::length(last_ - last_press_at_) < kClickPixels;
    if (twice) {
        if (const auto point = surface(last_)) camera.set_pivot(*point);
    }
    last_press_ = twice ? -1 : event.time;
    last_press_at_ = last_;
    return true;
}

bool Navigation::move(const InputEvent& event, const PictureArea& area, CameraController& camera) {
    const glm::dvec2 at = area.inside(event.x, event.y);
    const glm::dvec2 shift = at - last_;
    last_ = at;
    if (!button_) return false;
    travelled_ += glm::length(shift);
    switch (*button_) {
        case Button::kLeft:
            if ((modifiers_ & kShift) != 0) {
                camera.pan(shift.x, shift.y, area.size);
            } else if ((modifiers_ & kControl) != 0) {
                camera.roll(-180 * shift.x / area.size.height);
            } else {
                camera.orbit(shift.x, shift.y, area.size, style);
            }
            break;
        case Button::kMiddle:
            camera.pan(shift.x, shift.y, area.size);
            break;
        case Button::kRight:
            camera.look(shift.x, shift.y, area.size);
            break;
    }
    return true;
}

bool Navigation::key(const InputEvent& event, const PictureArea& area, CameraController& camera) {
    fast_ = (event.modifiers & kShift) != 0;
    if (event.code > 0 && event.code < 128 && kFlyingKeys.find(static_cast<char>(event.code)) != kFlyingKeys.npos) {
        if (event.pressed) {
            keys_.insert(event.code);
        } else {
            keys_.erase(event.code);
        }
        if (button_ == Button::kRight) return true;
    }
    if (!event.pressed) return false;
    const bool opposite = (event.modifiers & kControl) != 0;
    const bool keypad = event.code >= kKeypad0 && event.code <= kKeypad9;
    switch (keypad ? '0' + (event.code - kKeypad0) : event.code) {
        case 'F':
            camera.frame_all(area.size);
            return true;
        case '1':
            camera.view_from(opposite ? Side::kBack : Side::kFront);
            return true;
        case '3':
            camera.view_from(opposite ? Side::kLeft : Side::kRight);
            return true;
        case '7':
            camera.view_from(opposite ? Side::kBottom : Side::kTop);
            return true;
        case '5':
            camera.set_orthographic(!camera.orthographic());
            return true;
        default:
            return false;
    }
}

bool Navigation::advance(double seconds, CameraController& camera) const {
    if (button_ != Button::kRight || keys_.empty()) return false;
    const auto axis = [&](int positive, int negative) {
        return static_cast<double>(keys_.contains(positive)) - static_cast<double>(keys_.contains(negative));
    };
    camera.fly({axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')}, seconds, fast_ ? kFast : 1);
    return true;
}

}  // namespace splice
