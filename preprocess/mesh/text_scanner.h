// Numbers and lines of text formats, without locale and without allocation.
#pragma once

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace splice {

inline constexpr bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
inline constexpr bool is_space(char c) {
    return is_blank(c) || c == '\n' || c == '\r';
}

/// Without white space at either end.
inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_space(text.back()))
        text.remove_suffix(1);
    return text;
}

/// For messages: what a file says must not steer a terminal, and need not fill it.
inline std::string printable(std::string_view text) {
    constexpr std::size_t kLongest = 80;
    std::string result;
    for (const char c : text.substr(0, kLongest))
        result += c >= ' ' && c <= '~' ? c : '?';
    if (text.size() > kLongest) result += "...";
    return result;
}

/// A view that shrinks from the front as it is read.
class TextScanner {
  public:
    explicit TextScanner(std::string_view text) : begin_(text.data()), at_(begin_), end_(begin_ + text.size()) {}

    bool at_end() const { return at_ == end_; }
    char peek() const { return *at_; }
    void skip(std::size_t n) { at_ += n; }
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
    std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

    void skip_blanks() {
        while (at_ != end_ && is_blank(*at_))
            ++at_;
    }
    void skip_spaces() {
        while (at_ != end_ && is_space(*at_))
            ++at_;
    }

    /// The next run of characters that are no white space; empty at the end.
    std::string_view token() {
        skip_spaces();
        return token_here();
    }
    /// The same, but stays on the line.
    std::string_view token_on_line() {
        skip_blanks();
        return token_here();
    }

    std::string_view rest_of_line() const {
        const char* stop = at_;
        while (stop != end_ && *stop != '\n' && *stop != '\r')
            ++stop;
        return {at_, static_cast<std::size_t>(stop - at_)};
    }

    /// The rest of the line; the scanner then stands on the next one. Ends at \n, \r\n or a lone \r.
    std::string_view line() {
        const char* start = at_;
        while (at_ != end_ && *at_ != '\n' && *at_ != '\r')
            ++at_;
        const std::string_view result(start, static_cast<std::size_t>(at_ - start));
        if (at_ != end_ && *at_++ == '\r' && at_ != end_ && *at_ == '\n') ++at_;
        return result;
    }

    /// The number at the start of the next token, after white space; the whole token is consumed. False, consuming
    /// nothing but white space, if there is none. Overflow gives infinity; "nan" and "inf" are numbers.
    bool number(double& value) {
        skip_spaces();
        return number_here(value);
    }
    bool number_on_line(double& value) {
        skip_blanks();
        return number_here(value);
    }

    /// 1-based line of the current position, for messages; counts from the start, so do not call it in a loop.
    std::size_t line_number() const {
        std::size_t lines = 1;
        for (const char* c = begin_; c != at_; ++c) {
            if (*c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n'))) ++lines;
        }
        return lines;
    }
    std::string where() const { return "line " + std::to_string(line_number()); }

  private:
    std::string_view token_here() {
        const char* start = at_;
        while (at_ != end_ && !is_space(*at_))
            ++at_;
        return {start, static_cast<std::size_t>(at_ - start)};
    }
    bool number_here(double& value) {
        const char* start = at_;
        if (start != end_ && *start == '+') ++start;
        const auto [stop, error] = std::from_chars(start, end_, value);
        if (error == std::errc::result_out_of_range) {
            value = out_of_range(start, stop);
        } else if (error != std::errc()) {
            return false;
        }
        at_ = stop;
        while (at_ != end_ && !is_space(*at_))
            ++at_;
        return true;
    }
    /// from_chars does not say which way a number left the range of double.
    static double out_of_range(const char* start, const char* stop) {
        const std::string_view digits(start, static_cast<std::size_t>(stop - start));
        const auto exponent = digits.find_first_of("eE");
        const bool tiny = exponent != std::string_view::npos ? digits.substr(exponent + 1).starts_with('-')
                                                             : digits.find_first_of("123456789") > digits.find('.');
        if (tiny) return 0.0;
        return digits.starts_with('-') ? -std::numeric_limits<double>::infinity()
                                       : std::numeric_limits<double>::infinity();
    }

    const char* begin_;
    const char* at_;
    const char* end_;
};

}  // namespace splice
