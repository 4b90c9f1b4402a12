#include "engine/viewer/script.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

namespace splice {

namespace {

using Words = std::vector<std::string>;

// Arguments: n number, i whole number from 1, b button, s text; the last may repeat (*) or be left out (?).
struct Action {
    std::string_view name, arguments;
    std::string_view expected;
};

constexpr std::array<Action, 37> kActions{{
    {"move", "nn", "X Y"},
    {"press", "b", "left|middle|right"},
    {"release", "b", "left|middle|right"},
    {"click", "bnn", "left|middle|right X Y"},
    {"double-click", "nn", "X Y"},
    {"drag", "bnnnni?", "left|middle|right FROM_X FROM_Y TO_X TO_Y [FRAMES]"},
    {"wheel", "n", "NOTCHES"},
    {"key", "s", "[control+|shift+]KEY"},
    {"hold", "s", "[control+|shift+]KEY"},
    {"let-go", "s", "KEY"},
    {"drop", "s*", "FILE..."},
    {"open", "s*", "FILE..."},
    {"resize", "ii", "WIDTH HEIGHT"},
    {"minimise", "", "nothing"},
    {"restore", "", "nothing"},
    {"monitor-scale", "n", "FACTOR"},
    {"view", "s", "VIEW"},
    {"next-view", "n", "1|-1"},
    {"set", "ss", "NAME VALUE"},
    {"compare", "s", "off|side-by-side|wipe"},
    {"rebake", "", "nothing"},
    {"screenshot", "s", "FILE.png"},
    {"screenshot-window", "s", "FILE.png"},
    {"camera-line", "s", "FILE"},
    {"copy-camera", "", "nothing"},
    {"save-scene", "s", "FILE.json"},
    {"bookmark", "s", "NAME"},
    {"go", "s", "NAME"},
    {"forget", "s", "NAME"},
    {"turntable", "is", "FRAMES FILE.png"},
    {"panels", "s", "on|off"},
    {"statistics", "s", "FILE.json"},
    {"lose-device", "", "nothing"},
    {"lose-surface", "", "nothing"},
    {"wait", "", "nothing"},
    {"frames", "i", "COUNT"},
    {"quit", "", "nothing"},
}};

std::optional<double> number_of(const std::string& word) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<Button> button_of(const std::string& word) {
    if (word == "left") return Button::kLeft;
    if (word == "middle") return Button::kMiddle;
    if (word == "right") return Button::kRight;
    return std::nullopt;
}

bool fits(char kind, const std::string& word) {
    const std::optional<double> number = number_of(word);
    switch (kind) {
        case 'n':
            return number.has_value();
        case 'i':
            return number && *number >= 1 && *number <= 1e9 && *number == std::floor(*number);
        case 'b':
            return button_of(word).has_value();
        default:
            return !word.empty();
    }
}

bool fits(const Action& action, const Words& arguments) {
    std::string_view kinds = action.arguments;
    std::size_t most = kinds.size(), least = kinds.size();
    if (kinds.ends_with('*')) {
        kinds.remove_suffix(1);
        least = kinds.size();
        most = arguments.size();
    } else if (kinds.ends_with('?')) {
        kinds.remove_suffix(1);
        most = kinds.size();
        least = most - 1;
    }
    if (arguments.size() < least || arguments.size() > most) return false;
    for (std::size_t i = 0; i < arguments.size(); ++i)
        if (!fits(kinds[std::min(i, kinds.size() - 1)], arguments[i])) return false;
    return true;
}

// Words are separated by blanks; in double quotes, blanks belong to the word. A # starts a comment at the start of a
// line and before a blank; #ff8000 is a colour.
Words words_of(std::string_view line) {
    Words words;
    std::string word;
    bool quoted = false, open = false;
    const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"') {
            quoted = !quoted;
            open = true;
        } else if (!quoted && is_blank(c)) {
            if (open) words.push_back(std::exchange(word, ""));
            open = false;
        } else if (!quoted && !open && c == '#' && (words.empty() || i + 1 == line.size() || is_blank(line[i + 1]))) {
            return words;
        } else {
            word += c;
            open = true;
        }
    }
    if (open) words.push_back(word);
    return words;
}

// Builds the events of a script's hand, which has a place.
class ScriptBuilder {
  public:
    std::vector<ScriptStep> steps;

    void add(const std::string& name, const Words& arguments, std::size_t line) {
        line_ = line;
        clock_ += 1;  // clicks of two lines are not a double click
        const auto number = [&](std::size_t i) { return number_of(arguments[i]).value_or(0); };
        if (name == "move") {
            move(number(0), number(1));
        } else if (name == "press" || name == "release") {
            button(*button_of(arguments[0]), name == "press");
        } else if (name == "click") {
            move(number(1), number(2));
            click(*button_of(arguments[0]));
        } else if (name == "double-click") {
            move(number(0), number(1));
            click(Button::kLeft);
            click(Button::kLeft);
        } else if (name == "drag") {
            drag(arguments, arguments.size() > 5 ? static_cast<int>(number(5)) : 8);
        } else if (name == "wheel") {
            InputEvent& event = add_event(InputEvent::Kind::kWheel);
            event.x = 0;
            event.y = number(0);
        } else if (name == "key") {
            key(arguments[0], true);
            key(arguments[0], false);
        } else if (name == "hold" || name == "let-go") {
            key(arguments[0], name == "hold");
        } else if (name == "drop") {
            InputEvent& event = add_event(InputEvent::Kind::kDrop);
            event.files.assign(arguments.begin(), arguments.end());
        } else if (name == "wait") {
            steps.emplace_back(WaitForRest{});
        } else if (name == "frames") {
            steps.emplace_back(DrawFrames{static_cast<std::uint64_t>(number(0))});
        } else {
            steps.emplace_back(Command{name, arguments, line});
        }
    }

  private:
    InputEvent& add_event(InputEvent::Kind kind) {
        InputEvent event;
        event.kind = kind;
        event.line = line_;
        event.time = clock_ += 0.02;
        event.x = x_;
        event.y = y_;
        return std::get<InputEvent>(steps.emplace_back(std::move(event)));
    }
    void move(double x, double y) {
        x_ = x;
        y_ = y;
        add_event(InputEvent::Kind::kCursor);
    }
    void button(Button which, bool pressed) {
        InputEvent& event = add_event(InputEvent::Kind::kButton);
        event.code = static_cast<int>(which);
        event.pressed = pressed;
        event.modifiers = held_;
    }
    void click(Button which) {
        button(which, true);
        button(which, false);
    }
    void drag(const Words& arguments, int frames) {
        const auto number = [&](std::size_t i) { return number_of(arguments[i]).value_or(0); };
        const Button which = *button_of(arguments[0]);
        move(number(1), number(2));
        button(which, true);
        for (int i = 1; i <= frames; ++i) {
            const double share = static_cast<double>(i) / frames;
            move(number(1) + (number(3) - number(1)) * share, number(2) + (number(4) - number(2)) * share);
        }
        button(which, false);
    }
    void key(std::string_view name, bool pressed) {
        int modifiers = held_;
        for (const auto& [prefix, bit] : {std::pair<std::string_view, int>{"control+", kControl}, {"shift+", kShift}}) {
            if (!name.starts_with(prefix)) continue;
            name.remove_prefix(prefix.size());
            modifiers |= bit;
        }
        if (name == "shift") held_ = pressed ? held_ | kShift : held_ & ~kShift;
        if (name == "control") held_ = pressed ? held_ | kControl : held_ & ~kControl;
        InputEvent& event = add_event(InputEvent::Kind::kKey);
        event.code = key_of_name(name);
        event.pressed = pressed;
        event.modifiers = modifiers;
    }

    double clock_ = 0;  // seconds; the hand's own, so that slow frames tear no double click apart
    double x_ = 0, y_ = 0;
    int held_ = 0;  // modifiers
    std::size_t line_ = 0;
};

std::string text_of(std::istream& stream) {
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool names_key(std::string_view name) {
    for (const std::string_view prefix : {"control+", "shift+"})
        if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
    return key_of_name(name) != 0;
}

}  // namespace

double Command::number(std::size_t argument) const {
    return number_of(arguments[argument]).value_or(0);
}

int key_of_name(std::string_view name) {
    // GLFW's numbers: characters are themselves, in upper case.
    if (name.size() == 1 && std::isgraph(static_cast<unsigned char>(name[0])) != 0)
        return std::toupper(static_cast<unsigned char>(name[0]));
    constexpr std::array<std::pair<std::string_view, int>, 9> named{{{"space", 32},
                                                                     {"escape", 256},
                                                                     {"enter", 257},
                                                                     {"tab", 258},
                                                                     {"right", 262},
                                                                     {"left", 263},
                                                                     {"f12", 301},
                                                                     {"shift", 340},
                                                                     {"control", 341}}};
    for (const auto& [known, number] : named)
        if (known == name) return number;
    constexpr std::string_view keypad = "keypad-";
    if (name.size() == keypad.size() + 1 && name.starts_with(keypad) && name.back() >= '0' && name.back() <= '9')
        return kKeypad0 + (name.back() - '0');
    return 0;
}

std::vector<ScriptStep> parse_script(std::string_view text, const std::string& name) {
    ScriptBuilder builder;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string where = "line " + std::to_string(++number);
        Words words = words_of(line);
        if (words.empty()) continue;
        const std::string verb = words.front();
        words.erase(words.begin());
        const auto known =
            std::find_if(kActions.begin(), kActions.end(), [&](const Action& action) { return action.name == verb; });
        if (known == kActions.end())
            throw InputError(name, where, "unknown action \"" + verb + "\" (docs/viewer.md lists them)");
        const bool is_key = verb == "key" || verb == "hold" || verb == "let-go";
        if (!fits(*known, words) || (is_key && !names_key(words[0])))
            throw InputError(name, where, "expected " + std::string(known->expected) + " after " + verb);
        builder.add(verb, words, number);
    }
    return std::move(builder.steps);
}

std::vector<ScriptStep> read_script(const std::filesystem::path& path) {
    if (path == "-") return parse_script(text_of(std::cin), "script");
    std::error_code status;
    if (std::filesystem::is_directory(path, status))
        throw SystemError("cannot read " + path.string() + ": is a directory");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SystemError("cannot read " + path.string() + ": " + std::strerror(errno));
    return parse_script(text_of(file), path.string());
}

}  // namespace splice
