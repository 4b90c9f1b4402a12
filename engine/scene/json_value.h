// A value of a JSON file together with where it stands, so that every complaint names its place.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace splice {

class JsonValue {
  public:
    JsonValue(const nlohmann::json& json, const std::string& file, std::string path = "")
        : json_(json), file_(file), path_(std::move(path)) {}

    /// Throws InputError("FILE: /path: expected EXPECTED, got VALUE").
    [[noreturn]] void fail(const std::string& expected) const;

    /// Must be an object, and have no members but these.
    void expect_members(std::initializer_list<std::string_view> known) const;
    std::optional<JsonValue> member(std::string_view name) const;
    JsonValue required(std::string_view name) const;

    /// Must be an array of `least` to `most` elements.
    std::size_t array_size(std::size_t least, std::size_t most = std::numeric_limits<std::size_t>::max()) const;
    JsonValue element(std::size_t index) const;

    bool is_string() const { return json_.is_string(); }
    bool is_array() const { return json_.is_array(); }
    bool is_number() const { return json_.is_number(); }
    const nlohmann::json& json() const { return json_; }
    const std::string& path() const { return path_; }

    std::string string() const;
    bool boolean() const;
    /// A finite number in [least, most]; `expected` describes it.
    double number(double least, double most, const std::string& expected) const;
    double any_number() const;
    double positive_number() const;
    std::uint32_t whole_number(std::uint32_t least, std::uint32_t most) const;
    glm::dvec3 vector() const;

  private:
    const nlohmann::json& json_;
    const std::string& file_;
    std::string path_;
};

}  // namespace splice
