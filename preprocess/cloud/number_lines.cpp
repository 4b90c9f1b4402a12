#include "preprocess/cloud/number_lines.h"

#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

namespace splice {
namespace {

// Bytes that one task reads at least; a piece ends with a line.
constexpr std::size_t kPiece = 1 << 20;

bool is_separator(char c) {
    return is_blank(c) || c == ',' || c == ';';
}

bool is_comment(std::string_view line) {
    return line.starts_with('#') || line.starts_with("//");
}

struct Piece {
    std::string_view text;
    std::vector<double> values;
    std::optional<std::size_t> bad_offset;  // of a line that cannot be read, from the start of the piece
};

std::vector<Piece> cut(std::string_view text) {
    std::vector<Piece> pieces;
    while (!text.empty()) {
        std::size_t size = text.size();
        if (size > kPiece) {
            const std::size_t end = text.find_first_of("\n\r", kPiece);
            if (end != std::string_view::npos) size = end + 1;
        }
        pieces.push_back({text.substr(0, size), {}, {}});
        text.remove_prefix(size);
    }
    return pieces;
}

void read_piece(Piece& piece, std::size_t width) {
    TextScanner scanner(piece.text);
    std::vector<double> numbers;
    while (!scanner.at_end()) {
        const std::size_t at = scanner.offset();
        const std::string_view line = trimmed(scanner.line());
        if (line.empty() || is_comment(line)) continue;
        numbers.clear();
        const bool clean = numbers_of_line(line, width, numbers);
        if (numbers.size() == width) {
            piece.values.insert(piece.values.end(), numbers.begin(), numbers.end());
        } else if (!clean || numbers.size() != 1) {
            piece.bad_offset = at;
            return;
        }
    }
}

}  // namespace

bool numbers_of_line(std::string_view line, std::size_t most, std::vector<double>& values) {
    const char *at = line.data(), *end = at + line.size();
    while (values.size() < most) {
        while (at != end && is_separator(*at))
            ++at;
        if (at == end || *at == '\n' || *at == '\r' || is_comment({at, static_cast<std::size_t>(end - at)}))
            return true;
        const char* stop = std::find_if(at, end, [](char c) { return is_separator(c) || is_space(c); });
        double value = 0;
        TextScanner number({at, static_cast<std::size_t>(stop - at)});
        if (!number.number(value)) return false;
        values.push_back(value);
        at = stop;
    }
    return true;
}

NumberTable read_number_lines(std::string_view text, std::size_t width, std::size_t first_line,
                              const std::string& name) {
    std::vector<Piece> pieces = cut(text);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t p) { read_piece(pieces[p], width); });
    std::size_t total = 0;
    for (const Piece& piece : pieces) {
        if (piece.bad_offset) {
            TextScanner before(text);
            before.skip(static_cast<std::size_t>(piece.text.data() - text.data()) + *piece.bad_offset);
            throw InputError(name, "line " + std::to_string(first_line + before.line_number() - 1),
                             "expected " + std::to_string(width) + " numbers, found \"" +
                                 printable(trimmed(before.rest_of_line())) + "\"");
        }
        total += piece.values.size();
    }
    NumberTable table{width, {}};
    table.values.reserve(total);
    for (Piece& piece : pieces) {
        table.values.insert(table.values.end(), piece.values.begin(), piece.values.end());
        std::vector<double>().swap(piece.values);
    }
    return table;
}

}  // namespace splice
