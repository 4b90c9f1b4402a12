#include "engine/scene/json_value.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

std::string shortened(const std::string& text) {
    constexpr std::size_t kMost = 60;
    return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

std::string what_it_is(const nlohmann::json& json) {
    if (json.is_object()) return "an object";
    if (json.is_array()) return "an array of " + std::to_string(json.size());
    // Invalid UTF-8 must not throw from a message about something else.
    return shortened(json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
}

// JSON pointer escapes, RFC 6901.
std::string escaped(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == '~') {
            out += "~0";
        } else if (c == '/') {
            out += "~1";
        } else {
            out += c;
        }
    }
    return out;
}

}  // namespace

void JsonValue::fail(const std::string& expected) const {
    throw InputError(file_, path_.empty() ? "/" : path_, "expected " + expected + ", got " + what_it_is(json_));
}

void JsonValue::expect_members(std::initializer_list<std::string_view> known) const {
    if (!json_.is_object()) fail("an object");
    for (const auto& [name, value] : json_.items()) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string list;
        for (const std::string_view each : known)
            list += (list.empty() ? "" : ", ") + std::string(each);
        throw InputError(file_, path_ + "/" + shortened(escaped(name)), "unknown member, expected one of " + list);
    }
}

std::optional<JsonValue> JsonValue::member(std::string_view name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) return std::nullopt;
    return JsonValue(*found, file_, path_ + "/" + std::string(name));
}

JsonValue JsonValue::required(std::string_view name) const {
    if (!json_.is_object()) fail("an object");
    if (auto value = member(name)) return *value;
    throw InputError(file_, path_.empty() ? "/" : path_, "member \"" + std::string(name) + "\" is missing");
}

std::size_t JsonValue::array_size(std::size_t least, std::size_t most) const {
    if (json_.is_array() && json_.size() >= least && json_.size() <= most) return json_.size();
    if (least == most) fail("an array of " + std::to_string(least));
    fail("an array of " + std::to_string(least) + " or more");
}

JsonValue JsonValue::element(std::size_t index) const {
    return {json_.at(index), file_, path_ + "/" + std::to_string(index)};
}

std::string JsonValue::string() const {
    if (!json_.is_string()) fail("a string");
    return json_.get<std::string>();
}

bool JsonValue::boolean() const {
    if (!json_.is_boolean()) fail("true or false");
    return json_.get<bool>();
}

double JsonValue::number(double least, double most, const std::string& expected) const {
    if (!json_.is_number()) fail(expected);
    const auto value = json_.get<double>();
    if (!std::isfinite(value) || value < least || value > most) fail(expected);
    return value;
}

double JsonValue::any_number() const {
    return number(std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(), "a number");
}

double JsonValue::positive_number() const {
    return number(std::numeric_limits<double>::min(), std::numeric_limits<double>::max(), "a positive number");
}

std::uint32_t JsonValue::whole_number(std::uint32_t least, std::uint32_t most) const {
    const std::string expected = "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    const double value = number(least, most, expected);
    if (value != std::floor(value)) fail(expected);
    return static_cast<std::uint32_t>(value);
}

glm::dvec3 JsonValue::vector() const {
    if (!json_.is_array() || json_.size() != 3) fail("three numbers");
    return {element(0).any_number(), element(1).any_number(), element(2).any_number()};
}

}  // namespace splice
