#include "tests/bench/markup_checker.h"

#include <regex>
#include <vector>

namespace splice::test {
namespace {

bool text_is_clean(const std::string& text) {
    static const std::regex bare("&(?!(amp|lt|gt|quot);)");
    return !std::regex_search(text, bare);
}

}  // namespace

MarkupCheck check_markup(std::string_view text) {
    static const std::regex tag(R"re(/?([A-Za-z][A-Za-z0-9]*)((\s+[A-Za-z][A-Za-z0-9:-]*="[^"<]*")*)\s*(/?))re");
    MarkupCheck check;
    std::vector<std::string> open;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = text.find('<', at);
        if (!text_is_clean(std::string(text.substr(at, begin - at)))) check.problem = "a bare & in text";
        if (begin == std::string_view::npos) break;
        const size_t end = text.find('>', begin);
        if (end == std::string_view::npos) {
            check.problem = "a tag that does not end";
            break;
        }
        const std::string inside(text.substr(begin + 1, end - begin - 1));
        at = end + 1;
        if (inside.starts_with("!DOCTYPE")) continue;
        std::smatch match;
        if (!std::regex_match(inside, match, tag) || !text_is_clean(match[2])) {
            check.problem = "not a tag: " + inside;
            break;
        }
        if (inside[0] == '/') {
            if (open.empty() || open.back() != match[1]) {
                check.problem = "closes what is not open: " + inside;
                break;
            }
            open.pop_back();
            continue;
        }
        ++check.elements[match[1]];
        if (match[4].length() == 0) open.push_back(match[1]);
    }
    if (check.problem.empty() && !open.empty()) check.problem = "never closed: " + open.back();
    return check;
}

}  // namespace splice::test
