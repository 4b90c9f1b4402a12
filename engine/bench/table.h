// Columns of figures for people.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace splice::bench {

/// The first column is aligned left, the others right; column widths follow from the contents.
class Table {
  public:
    explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    std::string text() const;

    /// For rows printed one by one: columns are at least this wide, so that later rows fit under earlier ones.
    void reserve(std::vector<std::size_t> widths) { reserved_ = std::move(widths); }
    std::string last_line() const;

  private:
    std::vector<std::size_t> widths() const;
    static std::string line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths);

    std::vector<std::size_t> reserved_;
    std::vector<std::vector<std::string>> rows_;
};

/// The middle value; the lower of the two middle ones for an even count. `values` must not be empty.
double median(std::vector<double> values);

}  // namespace splice::bench
