// Scripts: what actions become, and what is said of those that are not understood.
#include "engine/viewer/script.h"
#include "preprocess/model_format/error.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>

using namespace splice;

namespace {

std::vector<ScriptStep> parse(const std::string& text) {
    return parse_script(text, "tour.txt");
}

const InputEvent& event(const ScriptStep& step) {
    return std::get<InputEvent>(step);
}

}  // namespace

TEST_CASE("a drag is a move, a press, moves and a release, all at their places") {
    const auto steps = parse("drag left 10 20 30 60 4");
    REQUIRE(steps.size() == 7);
    CHECK(event(steps[0]).kind == InputEvent::Kind::kCursor);
    CHECK(event(steps[1]).kind == InputEvent::Kind::kButton);
    CHECK(event(steps[1]).pressed);
    CHECK(event(steps[1]).x == 10);
    CHECK(event(steps[3]).x == 20);
    CHECK(event(steps[3]).y == 40);
    CHECK(event(steps[5]).x == 30);
    CHECK_FALSE(event(steps[6]).pressed);
    CHECK(event(steps[6]).y == 60);
}

TEST_CASE("held modifiers go with buttons, prefixes with keys") {
    const auto steps = parse("hold shift\npress left\nrelease left\nlet-go shift\nkey control+3\npress middle");
    CHECK(event(steps[1]).modifiers == kShift);
    CHECK(event(steps[4]).code == '3');
    CHECK(event(steps[4]).modifiers == kControl);
    CHECK(event(steps[6]).modifiers == 0);
    CHECK(event(steps[6]).code == static_cast<int>(Button::kMiddle));
}

TEST_CASE("the two presses of a double click are close in time, those of two clicks are not") {
    const auto twice = parse("double-click 5 6");
    REQUIRE(twice.size() == 5);
    CHECK(event(twice[3]).time - event(twice[1]).time < 0.1);
    const auto apart = parse("click left 5 6\nclick left 5 6");
    REQUIRE(apart.size() == 6);
    CHECK(event(apart[4]).time - event(apart[1]).time > 0.5);
}

TEST_CASE("commands keep their words, quotes hold blanks together, # starts a comment") {
    const auto steps = parse(
        "# a tour\n\n  open \"a b.ply\" c.obj  # both\nset background #ff0000\n"
        "set background \"#ff0000\"\nwait\nframes 12\n");
    REQUIRE(steps.size() == 5);
    CHECK(std::get<Command>(steps[0]).arguments == std::vector<std::string>{"a b.ply", "c.obj"});
    CHECK(std::get<Command>(steps[2]).arguments == std::get<Command>(steps[1]).arguments);
    CHECK(std::get<Command>(steps[1]).arguments == std::vector<std::string>{"background", "#ff0000"});
    CHECK(std::holds_alternative<WaitForRest>(steps[3]));
    CHECK(std::get<DrawFrames>(steps[4]).count == 12);
}

TEST_CASE("the wheel turns where the hand is") {
    const auto steps = parse("move 7 8\nwheel -2");
    CHECK(event(steps[1]).kind == InputEvent::Kind::kWheel);
    CHECK(event(steps[1]).x == 0);
    CHECK(event(steps[1]).y == -2);
}

TEST_CASE("what is not understood is told with its line") {
    struct Wrong {
        const char* text;
        const char* said;
    };
    for (const Wrong& wrong :
         {Wrong{"wait\nfly away", "line 2: unknown action \"fly\""}, Wrong{"move 1", "line 1: expected X Y"},
          Wrong{"move 1 x", "expected X Y"}, Wrong{"drag left 1 2 3", "expected left|middle|right"},
          Wrong{"press thumb", "left|middle|right"}, Wrong{"frames 0", "COUNT"}, Wrong{"frames 1.5", "COUNT"},
          Wrong{"key nokey", "KEY"}, Wrong{"wait 3", "expected nothing"}, Wrong{"drop", "FILE"},
          Wrong{"resize 10 -4", "WIDTH HEIGHT"}, Wrong{"move nan 1", "X Y"}}) {
        INFO(wrong.text);
        CHECK_THROWS_AS(parse(wrong.text), InputError);
        CHECK_THROWS_WITH(parse(wrong.text), Catch::Contains(wrong.said) && Catch::StartsWith("tour.txt: line"));
    }
}

TEST_CASE("keys have the numbers of the window library") {
    CHECK(key_of_name("a") == 'A');
    CHECK(key_of_name("7") == '7');
    CHECK(key_of_name("tab") == 258);
    CHECK(key_of_name("nothing") == 0);
    CHECK(key_of_name("") == 0);
}
