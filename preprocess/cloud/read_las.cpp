// LAS, ASPRS's exchange format of lidar data, versions 1.0 to 1.4 (LAS Specification 1.4 R15, 2019): a header, then
// records of fixed size whose coordinates are whole numbers with a scale and an offset in the header.
#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/point_columns.h"
#include "preprocess/model_format/error.h"

#include <array>
#include <cmath>
#include <optional>

namespace splice {
namespace {

// Bytes of the header, from its table 3.
constexpr std::size_t kMinorVersion = 25, kHeaderSize = 94, kPointData = 96, kPointFormat = 104, kRecordLength = 105,
                      kLegacyPoints = 107, kScales = 131, kOffsets = 155, kPoints14 = 247;
constexpr std::size_t kHeader10 = 227, kHeader14 = 375;

struct PointFormat {
    std::size_t bytes;               // of a record, at least
    std::optional<std::size_t> red;  // where the colour is: three 16-bit numbers
    std::size_t flags;               // the byte with the withheld flag
    unsigned withheld;               // that flag
};
constexpr std::array<PointFormat, 11> kFormats = {{
    {20, {}, 15, 0x80},
    {28, {}, 15, 0x80},
    {26, 20, 15, 0x80},
    {34, 28, 15, 0x80},
    {57, {}, 15, 0x80},
    {63, 28, 15, 0x80},
    {30, {}, 15, 0x04},
    {36, 30, 15, 0x04},
    {38, 30, 15, 0x04},
    {59, {}, 15, 0x04},
    {67, 30, 15, 0x04},
}};

class LasParser {
  public:
    LasParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    PointCloud parse() {
        check_header();
        const auto format_byte = number<std::uint8_t>(kPointFormat);
        // LASzip sets the upper bits.
        if (format_byte >= 0x40)
            throw InputError(name_, "byte " + std::to_string(kPointFormat),
                             "the points are compressed (LAZ), expected plain LAS: uncompress it first, for example "
                             "with laszip or las2las");
        if (format_byte >= kFormats.size())
            throw InputError(name_, "byte " + std::to_string(kPointFormat),
                             "point format " + std::to_string(format_byte) + ", expected 0 to 10");
        const PointFormat& format = kFormats[format_byte];
        const std::size_t record = number<std::uint16_t>(kRecordLength);
        if (record < format.bytes)
            throw InputError(name_, "byte " + std::to_string(kRecordLength),
                             "records of " + std::to_string(record) + " bytes, point format " +
                                 std::to_string(format_byte) + " needs " + std::to_string(format.bytes));
        const std::size_t first = number<std::uint32_t>(kPointData);
        if (first < header_bytes_ || first > bytes_.size())
            throw InputError(name_, "byte " + std::to_string(kPointData),
                             "the points start at byte " + std::to_string(first) +
                                 ", not between the header and the "
                                 "end of the file");
        const std::uint64_t points = point_count();
        const std::uint64_t available = (bytes_.size() - first) / record;
        if (points > available)
            throw InputError(
                name_, "byte " + std::to_string(kLegacyPoints),
                std::to_string(points) + " points promised, the file has room for " + std::to_string(available));
        return gather_points(columns(format, bytes_.data() + first, record, points));
    }

  private:
    template <class T>
    T number(std::size_t at) const {
        T value;
        std::memcpy(&value, bytes_.data() + at, sizeof value);
        return value;
    }

    void check_header() {
        if (bytes_.size() < kHeader10)
            throw InputError(name_, "byte " + std::to_string(bytes_.size()),
                             "the file ends inside the LAS header of at least " + std::to_string(kHeader10) + " bytes");
        const int major = number<std::uint8_t>(kMinorVersion - 1), minor = number<std::uint8_t>(kMinorVersion);
        if (major != 1 || minor > 4)
            throw InputError(
                name_, "byte " + std::to_string(kMinorVersion - 1),
                "LAS version " + std::to_string(major) + "." + std::to_string(minor) + ", expected 1.0 to 1.4");
        is_14_ = minor == 4;
        header_bytes_ = number<std::uint16_t>(kHeaderSize);
        const std::size_t least = is_14_ ? kHeader14 : kHeader10;
        if (header_bytes_ < least || header_bytes_ > bytes_.size())
            throw InputError(name_, "byte " + std::to_string(kHeaderSize),
                             "a header of " + std::to_string(header_bytes_) + " bytes, expected at least " +
                                 std::to_string(least) + " and no more than the file");
    }

    // Version 1.4 has a second, larger field and may leave the old one at 0.
    std::uint64_t point_count() const {
        const std::uint64_t legacy = number<std::uint32_t>(kLegacyPoints);
        if (!is_14_) return legacy;
        const auto points = number<std::uint64_t>(kPoints14);
        return points != 0 ? points : legacy;
    }

    PointColumns columns(const PointFormat& format, const char* first, std::size_t record, std::uint64_t points) const {
        PointColumns columns;
        columns.records = points;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto scale = number<double>(kScales + 8 * k), offset = number<double>(kOffsets + 8 * k);
            if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset))
                throw InputError(name_, "byte " + std::to_string(kScales + 8 * k),
                                 "a coordinate's scale or offset is unusable");
            columns.position[k] = {first + 4 * k, record, PlyType::kInt32, false, scale, offset};
        }
        columns.flags = {first + format.flags, record, PlyType::kUint8, false, 1, 0};
        columns.withheld_if = format.withheld;
        if (format.red) add_colours(columns, first + *format.red, record);
        return columns;
    }

    // Components should use all 16 bits, but many writers leave them at 8. No colour at all is no colour.
    static void add_colours(PointColumns& columns, const char* first, std::size_t record) {
        double largest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            columns.colour[k] = {first + 2 * k, record, PlyType::kUint16, false, 1, 0};
            // All that matters is whether it is 0, of 8 bits, or more.
            for (std::size_t point = 0; point < columns.records && largest <= 255; ++point)
                largest = std::max(largest, columns.colour[k][point]);
        }
        for (ScalarColumn& column : columns.colour) {
            column.scale = largest > 255 ? 1.0 / 65535 : 1.0 / 255;
            if (largest == 0) column.first = nullptr;
        }
    }

    std::string_view bytes_;
    const std::string& name_;
    bool is_14_ = false;
    std::size_t header_bytes_ = 0;
};

}  // namespace

PointCloud parse_las(std::string_view bytes, const std::string& name) {
    return LasParser(bytes, name).parse();
}

}  // namespace splice
