#include "engine/bench/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace splice::bench {

std::vector<std::size_t> Table::widths() const {
    std::vector<std::size_t> widths = reserved_;
    for (const auto& row : rows_) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], row[c].size());
    }
    return widths;
}

std::string Table::line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
        line += c == 0 ? fmt::format("{:<{}}", row[c], widths[c]) : fmt::format("  {:>{}}", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

std::string Table::text() const {
    const std::vector<std::size_t> columns = widths();
    std::string text;
    for (const auto& row : rows_)
        text += line(row, columns);
    return text;
}

std::string Table::last_line() const {
    return line(rows_.back(), widths());
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace splice::bench
