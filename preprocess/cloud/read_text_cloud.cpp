// Text with a point a line. There is no standard: what the columns mean is told by what they hold.
#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/number_lines.h"
#include "preprocess/cloud/point_columns.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace splice {
namespace {

// Numbers of a line that are looked at, and lines from which the columns' meaning is told.
constexpr std::size_t kMostColumns = 16, kSample = 1000;

// Where the points begin, and how many numbers a line has.
struct Start {
    std::size_t offset = 0, line = 1, width = 0;
    std::optional<double> count;  // the line before the points, of one number
};

Start find_start(std::string_view bytes, const std::string& name) {
    // A heading names the columns; more lines than this without a point are no point cloud.
    constexpr int kMostHeadings = 16;
    TextScanner text(bytes);
    if (bytes.starts_with("\xEF\xBB\xBF")) text.skip(3);
    Start start;
    int headings = 0;
    std::vector<double> numbers;
    while (!text.at_end()) {
        start.offset = text.offset();
        const std::string_view line = trimmed(text.line());
        numbers.clear();
        const bool clean = numbers_of_line(line, kMostColumns, numbers);
        if (numbers.size() >= 3) {
            start.width = numbers.size();
            return start;
        }
        if (clean && numbers.size() == 1) start.count = numbers[0];
        if (!clean && !line.empty() && ++headings > kMostHeadings) break;
        ++start.line;
    }
    throw InputError(name, "", "has no line with the three coordinates of a point");
}

class Columns {
  public:
    Columns(const NumberTable& table, const std::string& extension)
        : table_(table), rows_(std::min(table.rows(), kSample)) {
        // PTS puts the intensity before the colour.
        std::size_t c = extension == ".pts" && (table.width == 4 || table.width == 7) ? 4 : 3;
        while (c + 3 <= table.width) {
            if (!colour_ && is_byte_colour(c)) {
                colour_ = c;
                colour_scale_ = 1.0 / 255;
                c += 3;
            } else if (!normal_ && is_normal(c)) {
                normal_ = c;
                c += 3;
            } else if (!colour_ && table.width == 6 && is_fraction_colour(c)) {
                colour_ = c;
                c += 3;
            } else {
                ++c;
            }
        }
    }

    PointColumns point_columns() const {
        PointColumns columns;
        columns.records = table_.rows();
        for (std::size_t k = 0; k < 3; ++k) {
            columns.position[k] = table_column(table_.values, table_.width, k);
            if (normal_) columns.normal[k] = table_column(table_.values, table_.width, *normal_ + k);
            if (colour_) columns.colour[k] = table_column(table_.values, table_.width, *colour_ + k, colour_scale_);
        }
        return columns;
    }

  private:
    double at(std::size_t row, std::size_t column) const { return table_.values[row * table_.width + column]; }

    template <class Test>
    bool all_triples(std::size_t column, const Test& test) const {
        for (std::size_t row = 0; row < rows_; ++row)
            if (!test(Vec3d(at(row, column), at(row, column + 1), at(row, column + 2)))) return false;
        return true;
    }

    // Whole numbers of 0..255, not all of them 0 or 1, which would be axis-parallel normals.
    bool is_byte_colour(std::size_t column) const {
        double largest = 0;
        const bool bytes = all_triples(column, [&](const Vec3d& v) {
            largest = std::max(largest, v.maxCoeff());
            return v.minCoeff() >= 0 && v.maxCoeff() <= 255 && v == Vec3d(v.array().round().matrix());
        });
        return bytes && largest > 1;
    }
    bool is_fraction_colour(std::size_t column) const {
        return all_triples(column, [](const Vec3d& v) { return v.minCoeff() >= 0 && v.maxCoeff() <= 1; });
    }
    // Unit vectors, or missing ones.
    bool is_normal(std::size_t column) const {
        bool any = false;
        const bool all = all_triples(column, [&](const Vec3d& v) {
            const bool missing = !v.allFinite() || v.squaredNorm() == 0;
            any = any || !missing;
            return missing || std::abs(v.norm() - 1) < 0.02;
        });
        return all && any;
    }

    const NumberTable& table_;
    std::size_t rows_;
    std::optional<std::size_t> normal_, colour_;
    double colour_scale_ = 1;
};

// Ohtake's PWN: all positions, then all normals.
bool is_positions_then_normals(const NumberTable& table, const Start& start, const std::string& extension) {
    return extension == ".pwn" && table.width == 3 && start.count && table.rows() % 2 == 0 &&
           *start.count == static_cast<double>(table.rows() / 2);
}

}  // namespace

PointCloud parse_text_cloud(std::string_view bytes, const std::string& extension, const std::string& name) {
    const Start start = find_start(bytes, name);
    const NumberTable table = read_number_lines(bytes.substr(start.offset), start.width, start.line, name);
    if (is_positions_then_normals(table, start, extension)) {
        PointColumns columns;
        columns.records = table.rows() / 2;
        for (std::size_t k = 0; k < 3; ++k) {
            columns.position[k] = table_column(table.values, 3, k);
            columns.normal[k] = table_column(table.values, 3, 3 * columns.records + k);
        }
        return gather_points(columns);
    }
    return gather_points(Columns(table, extension).point_columns());
}

}  // namespace splice
