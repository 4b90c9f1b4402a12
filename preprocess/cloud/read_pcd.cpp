// PCD, the Point Cloud Library's format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html.
#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/lzf.h"
#include "preprocess/cloud/number_lines.h"
#include "preprocess/cloud/pcd_header.h"
#include "preprocess/cloud/point_columns.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace splice {
namespace {

class PcdParser {
  public:
    PcdParser(std::string_view bytes, const std::string& name)
        : bytes_(bytes), name_(name), header_(parse_pcd_header(bytes, name)) {}

    PointCloud parse() {
        switch (header_.data) {
            case PcdData::kAscii:
                return ascii();
            case PcdData::kBinary:
                return binary();
            case PcdData::kBinaryCompressed:
                return compressed();
        }
        return {};
    }

  private:
    const PcdField* field(std::string_view name) const {
        const auto found = std::find_if(header_.fields.begin(), header_.fields.end(),
                                        [&](const PcdField& f) { return f.name == name && f.count > 0; });
        return found == header_.fields.end() ? nullptr : &*found;
    }

    // `column_of` makes the ScalarColumn of a field.
    template <class ColumnOf>
    PointColumns columns(std::size_t records, const ColumnOf& column_of) const {
        PointColumns columns;
        columns.records = records;
        const auto take = [&](const char* const(&names)[3], ScalarColumn(&into)[3]) {
            const PcdField* fields[3] = {field(names[0]), field(names[1]), field(names[2])};
            if (!std::all_of(fields, fields + 3, [](const PcdField* f) { return f != nullptr && f->scalar; }))
                return false;
            for (int k = 0; k < 3; ++k)
                into[k] = column_of(*fields[k]);
            return true;
        };
        if (!take({"x", "y", "z"}, columns.position)) throw InputError(name_, "", "has no fields x, y and z");
        take({"normal_x", "normal_y", "normal_z"}, columns.normal);
        const PcdField* rgb = field("rgb") != nullptr ? field("rgb") : field("rgba");
        if (rgb != nullptr && rgb->bytes == 4) {
            columns.packed_rgb = column_of(*rgb);
            // The bits of a float, too, are the colour.
            if (header_.data != PcdData::kAscii) columns.packed_rgb.type = PlyType::kUint32;
        }
        return columns;
    }

    PointCloud ascii() {
        NumberTable table =
            read_number_lines(bytes_.substr(header_.data_begin), header_.record_numbers, header_.data_line, name_);
        if (table.rows() < header_.points)
            throw InputError(
                name_, "",
                std::to_string(header_.points) + " points promised, " + std::to_string(table.rows()) + " found");
        unpack_ascii_colours(table);
        return gather_points(columns(header_.points, [&](const PcdField& f) {
            return table_column(table.values, table.width, f.first_number);
        }));
    }

    // A packed colour is written as a whole number, or as the float that has its bits.
    void unpack_ascii_colours(NumberTable& table) const {
        const PcdField* rgb = field("rgb") != nullptr ? field("rgb") : field("rgba");
        if (rgb == nullptr || rgb->bytes != 4) return;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            double& value = table.values[row * table.width + rgb->first_number];
            if (rgb->type == 'F') {
                value = std::bit_cast<std::uint32_t>(static_cast<float>(value));
            } else if (!(std::abs(value) < 4294967296.0)) {
                value = 0;
            } else {
                value = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
            }
        }
    }

    PointCloud binary() {
        const std::string_view data = bytes_.substr(header_.data_begin);
        require_bytes(data.size());
        return gather_points(columns(header_.points, [&](const PcdField& f) {
            return ScalarColumn{data.data() + f.offset, header_.record_bytes, *f.scalar, false, 1, 0};
        }));
    }

    void require_bytes(std::size_t available) const {
        if (header_.points > available / header_.record_bytes)
            throw InputError(name_, "byte " + std::to_string(header_.data_begin),
                             std::to_string(header_.points) + " points of " + std::to_string(header_.record_bytes) +
                                 " bytes promised, " + std::to_string(available) + " bytes found");
    }

    // Two sizes, then one LZF stream of all first fields, all second fields and so on.
    PointCloud compressed() {
        std::string_view stream = bytes_.substr(header_.data_begin);
        std::uint32_t sizes[2];
        if (stream.size() < sizeof sizes)
            throw InputError(name_, "byte " + std::to_string(bytes_.size()), "file ends before the compressed data");
        std::memcpy(sizes, stream.data(), sizeof sizes);
        stream.remove_prefix(sizeof sizes);
        if (sizes[0] > stream.size())
            throw InputError(
                name_, "byte " + std::to_string(header_.data_begin),
                std::to_string(sizes[0]) + " compressed bytes promised, " + std::to_string(stream.size()) + " found");
        require_bytes(sizes[1]);
        const auto data = decompress_lzf(stream.substr(0, sizes[0]), sizes[1]);
        if (!data)
            throw InputError(name_, "byte " + std::to_string(header_.data_begin),
                             "the compressed data are damaged or do not hold " + std::to_string(sizes[1]) + " bytes");
        return gather_points(columns(header_.points, [&](const PcdField& f) {
            return ScalarColumn{data->data() + f.offset * header_.points, f.bytes * f.count, *f.scalar, false, 1, 0};
        }));
    }

    std::string_view bytes_;
    const std::string& name_;
    PcdHeader header_;
};

}  // namespace

PointCloud parse_pcd(std::string_view bytes, const std::string& name) {
    return PcdParser(bytes, name).parse();
}

}  // namespace splice
