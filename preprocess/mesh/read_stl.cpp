// Normals in STL repeat what the corners say, and are often wrong or zero: repair computes them instead.
#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/sniff_format.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <array>
#include <bit>
#include <cstring>

namespace splice {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies");

/// Three own vertices for each triangle: STL has no sharing, welding restores it.
void add_corner(SourceMesh& mesh, const Vec3d& position) {
    mesh.corner_position.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(position);
}

SourceMesh parse_binary(std::string_view bytes, const std::string& name) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    if (bytes.size() < kHeader) {
        throw InputError(name, "byte " + std::to_string(bytes.size()), "ends inside the 84-byte STL header");
    }
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    const std::size_t complete = (bytes.size() - kHeader) / kTriangle;
    if (count > complete) {
        throw InputError(
            name, "byte 80",
            "header promises " + std::to_string(count) + " triangles, file holds " + std::to_string(complete));
    }
    SourceMesh mesh;
    mesh.polygon_begin.reserve(std::size_t{count} + 1);
    mesh.positions.reserve(3 * std::size_t{count});
    mesh.corner_position.reserve(3 * std::size_t{count});
    mesh.polygon_begin.push_back(0);
    for (std::size_t t = 0; t < count; ++t) {
        std::array<float, 12> values{};  // normal, then three corners
        std::memcpy(values.data(), bytes.data() + kHeader + t * kTriangle, sizeof values);
        for (std::size_t k = 3; k < 12; k += 3) {
            add_corner(mesh, Vec3f(values[k], values[k + 1], values[k + 2]).cast<double>());
        }
        mesh.polygon_begin.push_back(mesh.corner_position.size());
    }
    if (count < complete) {
        warn(mesh, "the file holds more than the " + std::to_string(count) +
                       " triangles of its header; the rest is left out");
    }
    return mesh;
}

SourceMesh parse_ascii(std::string_view bytes, const std::string& name) {
    SourceMesh mesh;
    mesh.polygon_begin.push_back(0);
    TextScanner text(bytes);
    const auto close_facet = [&] {
        if (mesh.corner_position.size() > mesh.polygon_begin.back()) {
            mesh.polygon_begin.push_back(mesh.corner_position.size());
        }
    };
    for (;;) {
        const std::string_view token = text.token();
        if (token.empty()) break;
        if (token == "vertex") {
            Vec3d position;
            if (!text.number(position.x()) || !text.number(position.y()) || !text.number(position.z())) {
                throw InputError(name, text.where(), "expected three numbers after \"vertex\"");
            }
            if (mesh.positions.size() >= kInvalidIndex) throw InputError(name, text.where(), "too many vertices");
            add_corner(mesh, position);
        } else if (token == "endloop" || token == "endfacet" || token == "endsolid" || token == "facet") {
            close_facet();
            if (token == "endsolid") text.line();  // the name
        } else if (token == "solid") {
            text.line();
        }
    }
    if (mesh.corner_position.size() > mesh.polygon_begin.back()) {
        throw InputError(name, text.where(), "ends inside a facet, expected \"endloop\"");
    }
    return mesh;
}

}  // namespace

SourceMesh parse_stl(std::string_view bytes, const std::string& name) {
    if (is_binary_stl(bytes)) return parse_binary(bytes, name);
    TextScanner text(bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes);
    const bool text_header = text.token() == "solid";
    // A damaged binary file may start with "solid" as well; but text holds no NUL.
    const bool looks_binary = bytes.substr(0, 512).find('\0') != std::string_view::npos;
    return text_header && !looks_binary ? parse_ascii(bytes, name) : parse_binary(bytes, name);
}

}  // namespace splice
