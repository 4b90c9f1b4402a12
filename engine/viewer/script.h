// What `splice-view --script` does, one action a line (docs/viewer.md). Hands act through the same events, panels
// through the same commands.
#pragma once

#include "engine/viewer/input.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace splice {

/// What the viewer is to do; its name and arguments were checked against the table of commands.
struct Command {
    std::string name;
    std::vector<std::string> arguments;
    std::size_t line = 0;  // of the script; 0: not a script's
    double number(std::size_t argument) const;
};

/// Frames pass until nothing is loading and the picture is whole.
struct WaitForRest {};
/// So many frames are drawn, whether anything changes or not.
struct DrawFrames {
    std::uint64_t count = 1;
};

/// One frame's worth; a line may be several.
using ScriptStep = std::variant<InputEvent, Command, WaitForRest, DrawFrames>;

/// Throws InputError("FILE: line N: ...").
std::vector<ScriptStep> parse_script(std::string_view text, const std::string& name);
/// "-" is standard input. Throws the same, SystemError.
std::vector<ScriptStep> read_script(const std::filesystem::path& path);

/// The number of a key: a character, or tab, escape, enter, space, f12, left, right, keypad-0 to keypad-9; 0 if there
/// is no such key.
int key_of_name(std::string_view name);

}  // namespace splice
