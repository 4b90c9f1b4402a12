// Columns of figures for people.
#pragma once

#include <string>
#include <vector>

namespace splice::bench {

/// The first column is aligned left, the others right; column widths follow from the contents.
class Table {
  public:
    explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    std::string text() const;

  private:
    std::vector<std::vector<std::string>> rows_;
};

/// The middle value; the lower of the two middle ones for an even count. `values` must not be empty.
double median(std::vector<double> values);

}  // namespace splice::bench
