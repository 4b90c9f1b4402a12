// The header of a PCD file, https://pointclouds.org/documentation/tutorials/pcd_file_format.html.
#pragma once

#include "preprocess/mesh/ply_header.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

enum class PcdData { kAscii, kBinary, kBinaryCompressed };

struct PcdField {
    std::string name;
    char type = 'F';                // F, I or U
    std::size_t bytes = 4;          // of an element: 1, 2, 4 or 8
    std::size_t count = 1;          // elements
    std::size_t offset = 0;         // bytes from the start of a record
    std::size_t first_number = 0;   // numbers of a record before it
    std::optional<PlyType> scalar;  // nothing for integers of eight bytes
};

struct PcdHeader {
    std::vector<PcdField> fields;
    std::uint64_t points = 0;
    PcdData data = PcdData::kAscii;
    std::size_t record_bytes = 0, record_numbers = 0;
    std::size_t data_begin = 0, data_line = 1;  // byte and line after the header
};

/// Throws InputError naming `name` and the line.
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name);

}  // namespace splice
