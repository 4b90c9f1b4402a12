// What a hand did: the one form in which real input and scripts reach the viewer.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <vector>

namespace splice {

/// Numbers of GLFW.
enum class Button : int { kLeft = 0, kRight = 1, kMiddle = 2 };

/// The keypad's digits, GLFW's numbers, too.
inline constexpr int kKeypad0 = 320, kKeypad9 = 329;

enum Modifiers : int { kShift = 1, kControl = 2, kAlt = 4 };

struct InputEvent {
    enum class Kind { kCursor, kButton, kWheel, kKey, kText, kDrop, kFocus };
    Kind kind = Kind::kCursor;
    double time = 0;       // seconds
    double x = 0, y = 0;   // cursor, button: where, in window coordinates; wheel: notches
    int code = 0;          // button; key (GLFW's number); text: the code point
    int scancode = 0;      // key
    bool pressed = false;  // button, key; focus: gained
    bool repeated = false;
    int modifiers = 0;                         // Modifiers
    std::vector<std::filesystem::path> files;  // dropped
    std::size_t line = 0;                      // of the script; 0: not a script's
};

using InputQueue = std::deque<InputEvent>;

}  // namespace splice
