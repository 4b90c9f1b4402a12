#include "preprocess/cloud/pcd_header.h"

#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <charconv>

namespace splice {
namespace {

class HeaderParser {
  public:
    HeaderParser(std::string_view bytes, const std::string& name) : text_(bytes), name_(name) {}

    PcdHeader parse() {
        for (bool more = true; more; ++header_.data_line) {
            if (text_.at_end()) fail("header has no \"DATA\"");
            const std::string_view line = trimmed(text_.line());
            if (!line.empty() && line.front() != '#') more = entry(line);
        }
        header_.data_begin = text_.offset();
        check();
        return std::move(header_);
    }

  private:
    // False for the last one.
    bool entry(std::string_view line) {
        TextScanner words(line);
        const std::string_view keyword = words.token();
        if (keyword == "FIELDS" || keyword == "COLUMNS") {
            for (std::string_view field = words.token(); !field.empty(); field = words.token()) {
                header_.fields.emplace_back();
                header_.fields.back().name = field;
            }
        } else if (keyword == "SIZE") {
            for (PcdField& field : header_.fields) {
                field.bytes = whole_number(words);
                if (field.bytes != 1 && field.bytes != 2 && field.bytes != 4 && field.bytes != 8)
                    fail("a field of " + std::to_string(field.bytes) + " bytes, expected 1, 2, 4 or 8");
            }
        } else if (keyword == "TYPE") {
            for (PcdField& field : header_.fields) {
                const std::string_view type = words.token();
                if (type != "F" && type != "I" && type != "U") fail("unknown type \"" + printable(type) + "\"");
                field.type = type.front();
            }
        } else if (keyword == "COUNT") {
            for (PcdField& field : header_.fields)
                field.count = whole_number(words);
        } else if (keyword == "WIDTH") {
            width_ = whole_number(words);
        } else if (keyword == "HEIGHT") {
            height_ = whole_number(words);
        } else if (keyword == "POINTS") {
            points_ = whole_number(words);
        } else if (keyword == "DATA") {
            data(words.token());
            return false;
        } else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
            fail("unknown header line \"" + printable(keyword) + "\"");
        }
        return true;
    }

    // Below 2^32, so that products of two fit.
    std::uint64_t whole_number(TextScanner& words) {
        const std::string_view token = words.token();
        std::uint32_t value = 0;
        const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), value);
        if (error != std::errc() || stop != token.data() + token.size())
            fail("expected a whole number, found \"" + printable(token) + "\"");
        return value;
    }

    void data(std::string_view kind) {
        if (kind == "ascii") {
            header_.data = PcdData::kAscii;
        } else if (kind == "binary") {
            header_.data = PcdData::kBinary;
        } else if (kind == "binary_compressed") {
            header_.data = PcdData::kBinaryCompressed;
        } else {
            fail("unknown data \"" + printable(kind) + "\", expected ascii, binary or binary_compressed");
        }
    }

    static std::optional<PlyType> scalar_of(char type, std::size_t bytes) {
        if (type == 'F') {
            if (bytes == 4) return PlyType::kFloat32;
            if (bytes == 8) return PlyType::kFloat64;
            return std::nullopt;
        }
        const bool sign = type == 'I';
        if (bytes == 1) return sign ? PlyType::kInt8 : PlyType::kUint8;
        if (bytes == 2) return sign ? PlyType::kInt16 : PlyType::kUint16;
        if (bytes == 4) return sign ? PlyType::kInt32 : PlyType::kUint32;
        return std::nullopt;
    }

    void check() {
        // A record of more numbers is no point's.
        constexpr std::size_t kMostNumbers = 1 << 20;
        for (PcdField& field : header_.fields) {
            field.offset = header_.record_bytes;
            field.first_number = header_.record_numbers;
            field.scalar = scalar_of(field.type, field.bytes);
            header_.record_bytes += field.bytes * field.count;
            header_.record_numbers += field.count;
            if (header_.record_numbers > kMostNumbers) fail("a point of too many numbers");
        }
        if (header_.record_numbers == 0) fail("header has no fields");
        if (points_) {
            header_.points = *points_;
        } else if (width_) {
            header_.points = *width_ * height_;
        } else {
            fail("header does not say how many points there are");
        }
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(name_, "line " + std::to_string(header_.data_line), problem);
    }

    TextScanner text_;
    const std::string& name_;
    PcdHeader header_;
    std::optional<std::uint64_t> width_, points_;
    std::uint64_t height_ = 1;
};

}  // namespace

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name) {
    return HeaderParser(bytes, name).parse();
}

}  // namespace splice
