#include "engine/bench/report/html_parts.h"

#include "engine/bench/report/report_style.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

namespace splice::bench {

std::string figure(std::string_view title, std::string_view caption, const std::string& drawing) {
    return fmt::format(
        "<figure>\n<h2>{}</h2>\n<p class=\"caption\">{}</p>\n<div class=\"drawing\">\n{}</div>\n</figure>\n",
        escape_markup(title), escape_markup(caption), drawing);
}

std::string tile(const std::string& value, std::string_view meaning, std::string_view goal, bool reached) {
    return fmt::format("<div class=\"tile {}\"><b>{}</b><span>{}</span><small>{}</small></div>\n",
                       reached ? "good" : "short", escape_markup(value), escape_markup(meaning), escape_markup(goal));
}

std::string html_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::string text = "<div class=\"drawing\"><table>\n<tr>";
    for (const std::string& cell : header)
        text += "<th>" + escape_markup(cell) + "</th>";
    text += "</tr>\n";
    for (const auto& row : rows) {
        text += "<tr>";
        for (const std::string& cell : row)
            text += "<td>" + escape_markup(cell) + "</td>";
        text += "</tr>\n";
    }
    return text + "</table></div>\n";
}

std::string page(std::string_view title, std::string_view caption, const std::string& body) {
    return fmt::format(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta "
        "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{0}</title>\n"
        "<style>\n{1}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n<p class=\"caption\">{2}</p>\n{3}"
        "</main>\n</body>\n</html>\n",
        escape_markup(title), kReportStyle, escape_markup(caption), body);
}

}  // namespace splice::bench
