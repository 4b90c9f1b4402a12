// Text of one record a line -> a table of numbers, in parallel.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

/// Row after row of `width` numbers.
struct NumberTable {
    std::size_t width = 0;
    std::vector<double> values;

    std::size_t rows() const { return width == 0 ? 0 : values.size() / width; }
};

/// The numbers at the start of a line, separated by white space, commas or semicolons; at most `most` of them. False if
/// something else follows before the line ends (a `#` or `//` begins a comment).
bool numbers_of_line(std::string_view line, std::size_t most, std::vector<double>& values);

/// `width` numbers from each line of `text`; what follows on the line is ignored. Empty lines, comments, and lines with
/// one whole number alone (counts) are skipped. Throws InputError with the line of the first one with fewer numbers;
/// `first_line` is the number of the first line of `text`.
NumberTable read_number_lines(std::string_view text, std::size_t width, std::size_t first_line,
                              const std::string& name);

}  // namespace splice
