// What the hand does, event by event, and what it means.
#include "engine/viewer/navigation.h"

#include <catch2/catch.hpp>

using namespace splice;

namespace {

const PictureArea kArea{100, 0, {640, 480}, 1};

InputEvent cursor(double x, double y) {
    InputEvent event;
    event.x = x;
    event.y = y;
    return event;
}

InputEvent button(Button which, bool pressed, double x, double y, double time = 0, int modifiers = 0) {
    InputEvent event;
    event.kind = InputEvent::Kind::kButton;
    event.code = static_cast<int>(which);
    event.pressed = pressed;
    event.x = x;
    event.y = y;
    event.time = time;
    event.modifiers = modifiers;
    return event;
}

InputEvent key(int code, bool pressed, int modifiers = 0) {
    InputEvent event;
    event.kind = InputEvent::Kind::kKey;
    event.code = code;
    event.pressed = pressed;
    event.modifiers = modifiers;
    return event;
}

struct Hand {
    Navigation navigation;
    CameraController camera;
    std::optional<glm::dvec3> surface;

    Hand() {
        camera.set_bounds({glm::dvec3(-1), glm::dvec3(1)});
        camera.set_camera(frame_camera(camera.bounds(), {}, 640, 480));
    }
    bool does(const InputEvent& event) {
        return navigation.handle(event, kArea, camera, [&](const glm::dvec2&) { return surface; });
    }
    glm::dvec3 eye() const { return camera.camera().eye; }
    void drag(Button which, int modifiers = 0) {
        does(cursor(300, 200));
        does(button(which, true, 300, 200, 0, modifiers));
        does(cursor(340, 220));
        does(button(which, false, 340, 220));
    }
};

}  // namespace

TEST_CASE("left drags orbit about the pivot, shift-left and middle drags pan, right drags look around") {
    Hand hand;
    const glm::dvec3 eye = hand.eye(), pivot = hand.camera.pivot();
    hand.drag(Button::kLeft);
    CHECK(glm::length(hand.eye() - eye) > 0.1);
    CHECK(hand.camera.pivot() == pivot);
    const glm::dvec3 turned = hand.eye();
    hand.drag(Button::kRight);
    CHECK(glm::length(hand.eye() - turned) < 1e-9);
    CHECK(hand.camera.pivot() != pivot);

    Hand middle, shifted;
    middle.drag(Button::kMiddle);
    shifted.drag(Button::kLeft, kShift);
    CHECK(middle.camera.pivot() != pivot);
    CHECK(glm::length(middle.eye() - shifted.eye()) < 1e-12);
    CHECK(glm::length((middle.eye() - eye) - (middle.camera.pivot() - pivot)) < 1e-12);
}

TEST_CASE("control-left drags roll") {
    Hand hand;
    const Camera before = hand.camera.camera();
    hand.drag(Button::kLeft, kControl);
    const Camera after = hand.camera.camera();
    CHECK(glm::length(after.eye - before.eye) < 1e-9);
    CHECK(glm::dot(after.up, before.up) == Approx(std::cos(glm::radians(180.0 * 40 / 480))));
}

TEST_CASE("moves without a button change nothing") {
    Hand hand;
    const Camera before = hand.camera.camera();
    CHECK_FALSE(hand.does(cursor(10, 10)));
    CHECK_FALSE(hand.does(cursor(300, 300)));
    CHECK(hand.camera.camera() == before);
}

TEST_CASE("a click is one without a drag, and tells its place in the picture") {
    Hand hand;
    hand.does(button(Button::kLeft, true, 300, 200));
    hand.does(cursor(301, 201));
    hand.does(button(Button::kLeft, false, 301, 201));
    const auto place = hand.navigation.take_click();
    REQUIRE(place);
    CHECK(place->x == 201);
    CHECK(place->y == 201);
    CHECK_FALSE(hand.navigation.take_click());
    hand.drag(Button::kLeft);
    CHECK_FALSE(hand.navigation.take_click());
}

TEST_CASE("a double click sets the pivot to the surface, two slow or distant clicks do not") {
    Hand hand;
    hand.surface = glm::dvec3(0.2, 0.3, 0.4);
    const auto click = [&](double time, double x) {
        hand.does(button(Button::kLeft, true, x, 200, time));
        hand.does(button(Button::kLeft, false, x, 200, time + 0.05));
    };
    click(1, 300);
    click(2, 300);
    CHECK(hand.camera.pivot() != *hand.surface);
    click(3, 300);
    click(3.2, 330);
    CHECK(hand.camera.pivot() != *hand.surface);
    click(5, 300);
    click(5.2, 300);
    CHECK(hand.camera.pivot() == *hand.surface);
}

TEST_CASE("the wheel zooms to what is under the cursor") {
    Hand hand;
    hand.surface = glm::dvec3(0.5, 0.5, 0.5);
    hand.does(cursor(300, 200));
    const double before = glm::length(hand.eye() - *hand.surface);
    InputEvent wheel;
    wheel.kind = InputEvent::Kind::kWheel;
    wheel.y = 1;
    CHECK(hand.does(wheel));
    CHECK(glm::length(hand.eye() - *hand.surface) == Approx(before * 6 / 7));
}

TEST_CASE("flying needs the right button and a key, is faster with shift, and ends when either is let go") {
    Hand hand;
    const glm::dvec3 eye = hand.eye();
    hand.does(key('W', true));
    CHECK_FALSE(hand.navigation.advance(0.1, hand.camera));
    hand.does(button(Button::kRight, true, 300, 200));
    CHECK(hand.navigation.advance(0.1, hand.camera));
    const double slow = glm::length(hand.eye() - eye);
    CHECK(slow > 0.01);
    hand.does(key('D', true, kShift));
    hand.does(key('W', false, kShift));
    const glm::dvec3 before = hand.eye();
    CHECK(hand.navigation.advance(0.1, hand.camera));
    CHECK(glm::length(hand.eye() - before) == Approx(4 * slow));
    hand.does(button(Button::kRight, false, 300, 200));
    CHECK_FALSE(hand.navigation.advance(0.1, hand.camera));
    hand.does(key('D', false));
    hand.does(button(Button::kRight, true, 300, 200));
    CHECK_FALSE(hand.navigation.advance(0.1, hand.camera));
}

TEST_CASE("keys: sides, opposite sides, parallel rays, all in sight") {
    Hand hand;
    const auto backwards = [&] {
        const Camera camera = hand.camera.camera();
        return glm::normalize(camera.eye - camera.target);
    };
    CHECK(hand.does(key('3', true)));
    CHECK(backwards().x == Approx(1));
    CHECK(hand.does(key('3', true, kControl)));
    CHECK(backwards().x == Approx(-1));
    CHECK(hand.does(key('7', true)));
    CHECK(backwards().y == Approx(1));
    CHECK(hand.does(key('5', true)));
    CHECK(hand.camera.orthographic());
    CHECK(hand.does(key('F', true)));
    CHECK_FALSE(hand.does(key('Z', true)));
}

TEST_CASE("a second button during a drag does not take it over") {
    Hand hand;
    hand.does(button(Button::kLeft, true, 300, 200));
    CHECK_FALSE(hand.does(button(Button::kMiddle, true, 300, 200)));
    CHECK_FALSE(hand.does(button(Button::kMiddle, false, 300, 200)));
    CHECK(hand.navigation.dragging());
    hand.does(button(Button::kLeft, false, 300, 200));
    CHECK_FALSE(hand.navigation.dragging());
}
