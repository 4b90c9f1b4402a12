#include "preprocess/mesh/obj_text.h"

#include "preprocess/mesh/text_scanner.h"

#include <algorithm>
#include <limits>

namespace splice {
namespace {

constexpr float kNoColour = std::numeric_limits<float>::quiet_NaN();

/// A logical line: continuation lines (a backslash at the end) joined into `joined`, which is left alone otherwise.
std::string_view logical_line(TextScanner& text, std::string& joined, std::size_t& line_number) {
    std::string_view line = text.line();
    ++line_number;
    if (!line.ends_with('\\')) return line;
    joined.clear();
    while (line.ends_with('\\')) {
        joined += line.substr(0, line.size() - 1);
        joined += ' ';
        line = text.line();
        ++line_number;
    }
    joined += line;
    return joined;
}

bool is_number_character(char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
}

class Tidier {
  public:
    explicit Tidier(std::size_t bytes) { out_.statements.reserve(bytes + 16); }

    void statement(std::string_view line, std::size_t line_number) {
        TextScanner words(line);
        const std::string_view keyword = words.token();
        if (keyword == "v") {
            vertex(words);
        } else if (keyword == "vt" || keyword == "vn") {
            copy(keyword, words.rest());
        } else if (keyword == "f" || keyword == "fo") {  // `fo` is what old files call a face
            face(words, line_number);
        } else if (keyword == "usemtl") {
            copy(keyword, trimmed(words.rest()));
        } else if (keyword == "mtllib") {
            std::string escaped;
            for (const char c : trimmed(words.rest())) {
                if (c == ' ' || c == '\\') escaped += '\\';
                escaped += c;
            }
            copy(keyword, escaped);
        }
    }

    ObjText finish() {
        if (any_colour_) out_.vertex_colours.resize(vertices_, {kNoColour, kNoColour, kNoColour});
        return std::move(out_);
    }

  private:
    void copy(std::string_view keyword, std::string_view rest) {
        if (rest.find('\0') != std::string_view::npos) return;
        out_.statements.append(keyword);
        out_.statements += ' ';
        out_.statements.append(rest);
        out_.statements += '\n';
    }

    void vertex(TextScanner& words) {
        ++vertices_;
        words.skip_spaces();
        const std::string_view rest = words.rest();
        std::array<std::string_view, 3> coordinates;
        for (std::string_view& coordinate : coordinates) {
            coordinate = words.token();
            if (!std::all_of(coordinate.begin(), coordinate.end(), is_number_character)) {
                copy("v", "1e999 1e999 1e999");
                return;
            }
        }
        const auto used = static_cast<std::size_t>(coordinates[2].data() + coordinates[2].size() - rest.data());
        copy("v", coordinates[2].empty() ? rest : rest.substr(0, used));
        colour(words);
    }

    /// `v x y z r g b`, perhaps with alpha; a lone fourth number is the weight of a rational curve.
    void colour(TextScanner& words) {
        words.skip_spaces();
        if (words.at_end()) return;
        std::array<float, 3> rgb{};
        for (float& component : rgb) {
            double value = 0;
            if (!words.number(value)) return;
            component = static_cast<float>(value);
        }
        any_colour_ = true;
        out_.vertex_colours.resize(vertices_ - 1, {kNoColour, kNoColour, kNoColour});
        out_.vertex_colours.push_back(rgb);
    }

    void face(TextScanner& words, std::size_t line_number) {
        words.skip_spaces();
        std::string_view corners = words.rest();
        corners = trimmed(corners.substr(0, corners.find('#')));
        if (corners.empty()) return;  // tinyobjloader would not report it either
        out_.face_lines.push_back(static_cast<std::uint32_t>(line_number));
        constexpr std::size_t kSafeDigits = 9;  // any such number fits an int
        std::size_t digits = 0;
        bool safe = true;
        for (const char c : corners) {
            digits = c >= '0' && c <= '9' ? digits + 1 : 0;
            safe &= digits <= kSafeDigits && c != '\0';
        }
        copy("f", safe ? corners : std::string_view("0 0 0"));
    }

    ObjText out_;
    std::size_t vertices_ = 0;
    bool any_colour_ = false;
};

}  // namespace

ObjText tidy_obj_text(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    TextScanner text(bytes);
    Tidier tidier(bytes.size());
    std::string joined;
    std::size_t line_number = 0;
    while (!text.at_end()) {
        const std::size_t first_line = line_number + 1;
        const std::string_view line = logical_line(text, joined, line_number);
        tidier.statement(line, first_line);
    }
    return tidier.finish();
}

}  // namespace splice
