// The header of a PLY file (Turk 1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

enum class PlyEncoding { kAscii, kBinaryLittleEndian, kBinaryBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::kFloat32;
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;  // as the header says; at most one a byte of the file unless it has no properties
    std::vector<PlyProperty> properties;
    std::size_t line = 0;  // of the header, counted from 1

    std::string where() const { return "line " + std::to_string(line); }
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::kAscii;
    std::vector<PlyElement> elements;
    std::vector<std::string> texture_files;  // "comment TextureFile NAME"
    std::size_t data_begin = 0;              // byte offset of the first row
};

/// Throws InputError naming `name` and the line. Promises of more rows than the file has bytes for are refused.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace splice
