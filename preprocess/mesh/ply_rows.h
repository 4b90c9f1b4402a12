// Scalars of PLY rows, ascii or binary, behind one interface for the templated row loop of read_ply.cpp.
#pragma once

#include "preprocess/mesh/ply_header.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace splice {

class AsciiPlyRows {
  public:
    AsciiPlyRows(std::string_view bytes, std::size_t begin, const std::string& name) : text_(bytes), name_(name) {
        text_.skip(begin);
    }
    double scalar(PlyType /*type*/) {
        double value = 0;
        if (!text_.number(value)) {
            throw InputError(name_, text_.where(), text_.at_end() ? "file ends inside the data" : "expected a number");
        }
        return value;
    }
    std::size_t scalars_left(PlyType /*type*/) const { return (text_.rest().size() + 1) / 2; }
    std::string where() const { return text_.where(); }

  private:
    TextScanner text_;
    const std::string& name_;
};

template <std::endian Order>
class BinaryPlyRows {
  public:
    BinaryPlyRows(std::string_view bytes, std::size_t begin, const std::string& name)
        : bytes_(bytes), at_(begin), name_(name) {}

    double scalar(PlyType type) {
        switch (type) {
            case PlyType::kInt8:
                return read<std::int8_t>();
            case PlyType::kUint8:
                return read<std::uint8_t>();
            case PlyType::kInt16:
                return read<std::int16_t>();
            case PlyType::kUint16:
                return read<std::uint16_t>();
            case PlyType::kInt32:
                return read<std::int32_t>();
            case PlyType::kUint32:
                return read<std::uint32_t>();
            case PlyType::kFloat32:
                return read<float>();
            case PlyType::kFloat64:
                return read<double>();
        }
        return 0;
    }
    std::size_t scalars_left(PlyType type) const { return (bytes_.size() - at_) / size_of(type); }
    std::string where() const { return "byte " + std::to_string(at_); }

  private:
    template <class Value>
    double read() {
        if (bytes_.size() - at_ < sizeof(Value)) throw InputError(name_, where(), "file ends inside the data");
        char raw[sizeof(Value)];
        std::memcpy(raw, bytes_.data() + at_, sizeof raw);
        at_ += sizeof raw;
        if constexpr (Order != std::endian::native) {
            for (std::size_t i = 0; i < sizeof raw / 2; ++i)
                std::swap(raw[i], raw[sizeof raw - 1 - i]);
        }
        Value value;
        std::memcpy(&value, raw, sizeof value);
        return static_cast<double>(value);
    }

    std::string_view bytes_;
    std::size_t at_;
    const std::string& name_;
};

}  // namespace splice
