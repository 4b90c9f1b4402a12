#include "preprocess/mesh/ply_header.h"

#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <array>
#include <utility>

namespace splice {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

std::size_t smallest_row(const PlyElement& element, PlyEncoding encoding) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
        bytes += encoding == PlyEncoding::kAscii ? 2 : size_of(property.is_list ? property.count_type : property.type);
    }
    return bytes;
}

class HeaderParser {
  public:
    HeaderParser(std::string_view bytes, const std::string& name) : text_(bytes), name_(name) {}

    PlyHeader parse() {
        if (trimmed(text_.line()) != "ply") fail("expected \"ply\"");
        bool has_format = false;
        for (;;) {
            if (text_.at_end()) fail("header has no \"end_header\"");
            ++line_;
            const std::string_view line = text_.line();
            TextScanner words(line);
            const std::string_view keyword = words.token();
            if (keyword == "end_header") break;
            if (keyword == "format") {
                format(words);
                has_format = true;
            } else if (keyword == "element") {
                element(words);
            } else if (keyword == "property") {
                property(words);
            } else if (keyword == "comment") {
                if (words.token() == "TextureFile") header_.texture_files.emplace_back(trimmed(words.rest()));
            } else if (keyword != "obj_info" && !keyword.empty()) {
                fail("unknown header line \"" + printable(keyword) + "\"");
            }
        }
        if (!has_format) fail("header has no \"format\"");
        header_.data_begin = text_.offset();
        check_counts();
        return std::move(header_);
    }

  private:
    void format(TextScanner& words) {
        const std::string_view encoding = words.token();
        if (encoding == "ascii") {
            header_.encoding = PlyEncoding::kAscii;
        } else if (encoding == "binary_little_endian") {
            header_.encoding = PlyEncoding::kBinaryLittleEndian;
        } else if (encoding == "binary_big_endian") {
            header_.encoding = PlyEncoding::kBinaryBigEndian;
        } else {
            fail("unknown format \"" + printable(encoding) +
                 "\", expected ascii, binary_little_endian or binary_big_endian");
        }
    }

    void element(TextScanner& words) {
        PlyElement element;
        element.name = words.token();
        const std::string_view count = words.token();
        const auto [stop, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (element.name.empty() || error != std::errc() || stop != count.data() + count.size()) {
            fail("expected \"element NAME COUNT\" with a count of at least 0");
        }
        element.line = line_;
        header_.elements.push_back(std::move(element));
    }

    PlyType type(std::string_view type_name) const {
        for (const auto& [known, type] : kTypeNames) {
            if (type_name == known) return type;
        }
        fail("unknown property type \"" + printable(type_name) + "\"");
    }

    void property(TextScanner& words) {
        if (header_.elements.empty()) fail("property before any element");
        PlyProperty property;
        std::string_view first = words.token();
        if (first == "list") {
            property.is_list = true;
            property.count_type = type(words.token());
            if (property.count_type == PlyType::kFloat32 || property.count_type == PlyType::kFloat64) {
                fail("the length of a list must be of an integer type");
            }
            first = words.token();
        }
        property.type = type(first);
        property.name = words.token();
        if (property.name.empty()) fail("expected the name of a property");
        header_.elements.back().properties.push_back(std::move(property));
    }

    void check_counts() const {
        const std::size_t available = text_.rest().size();
        for (const PlyElement& element : header_.elements) {
            const std::size_t row = smallest_row(element, header_.encoding);
            // The last ascii row needs no line end.
            if (row > 0 && element.count > (available + 1) / row) {
                throw InputError(name_, element.where(),
                                 "header promises " + std::to_string(element.count) + " rows of \"" +
                                     printable(element.name) + "\", but only " + std::to_string(available) +
                                     " bytes follow");
            }
        }
    }

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(name_, "line " + std::to_string(line_), problem);
    }

    TextScanner text_;
    const std::string& name_;
    PlyHeader header_;
    std::size_t line_ = 1;
};

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::kInt8:
        case PlyType::kUint8:
            return 1;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 2;
        case PlyType::kInt32:
        case PlyType::kUint32:
        case PlyType::kFloat32:
            return 4;
        case PlyType::kFloat64:
            return 8;
    }
    return 0;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
    return HeaderParser(bytes, name).parse();
}

}  // namespace splice
