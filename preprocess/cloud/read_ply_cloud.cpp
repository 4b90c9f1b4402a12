// PLY, Turk 1994: http://paulbourke.net/dataformats/ply. Only the element "vertex" is read.
#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/point_columns.h"
#include "preprocess/mesh/ply_roles.h"
#include "preprocess/mesh/ply_rows.h"

#include <algorithm>
#include <array>

namespace splice {
namespace {

using RoleColumns = std::array<ScalarColumn, kRoles>;

PointColumns columns_of(const RoleColumns& roles, const PlyElement& element, const std::string& name) {
    PointColumns columns;
    columns.records = element.count;
    const auto take = [&](PlyRole first, ScalarColumn(&into)[3]) {
        const auto* begin = roles.begin() + first;
        if (std::all_of(begin, begin + 3, [](const ScalarColumn& column) { return bool(column); }))
            std::copy(begin, begin + 3, into);
    };
    take(kX, columns.position);
    take(kNormalX, columns.normal);
    take(kRed, columns.colour);
    if (!columns.position[0]) throw InputError(name, element.where(), "the vertices have no properties x, y and z");
    return columns;
}

double scale_of(PlyRole role, PlyType type) {
    return role >= kRed && role <= kBlue ? ply_colour_scale(type) : 1.0;
}

bool has_lists(const PlyElement& element) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [](const PlyProperty& property) { return property.is_list; });
}

std::size_t row_bytes(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += size_of(property.type);
    return bytes;
}

// Binary rows of fixed size are read where they lie.
PointCloud read_in_place(std::string_view bytes, const PlyHeader& header, std::size_t vertex, const std::string& name) {
    std::size_t at = header.data_begin;
    for (std::size_t e = 0; e <= vertex; ++e) {
        const PlyElement& element = header.elements[e];
        const std::size_t row = row_bytes(element);
        if (row != 0 && element.count > (bytes.size() - at) / row)
            throw InputError(name, "byte " + std::to_string(bytes.size()), "file ends inside the data");
        if (e < vertex) at += row * element.count;
    }
    const PlyElement& element = header.elements[vertex];
    RoleColumns roles;
    const std::size_t stride = row_bytes(element);
    for (const PlyProperty& property : element.properties) {
        const PlyRole role = ply_role_of(property.name);
        if (role != kNoRole)
            roles[role] = {bytes.data() + at,
                           stride,
                           property.type,
                           header.encoding == PlyEncoding::kBinaryBigEndian,
                           scale_of(role, property.type),
                           0};
        at += size_of(property.type);
    }
    return gather_points(columns_of(roles, element, name));
}

// Anything else goes through a table of numbers.
template <class Rows>
PointCloud read_row_by_row(Rows rows, const PlyHeader& header, std::size_t vertex, const std::string& name) {
    const auto skip_list = [&](const PlyProperty& property) {
        const double length = rows.scalar(property.count_type);
        if (!(length >= 0) || length > static_cast<double>(rows.scalars_left(property.type)))
            throw InputError(name, rows.where(), "list of impossible length");
        for (auto left = static_cast<std::size_t>(length); left > 0; --left)
            rows.scalar(property.type);
    };
    for (std::size_t e = 0; e < vertex; ++e) {
        const PlyElement& element = header.elements[e];
        if (element.properties.empty()) continue;
        for (std::uint64_t row = 0; row < element.count; ++row) {
            for (const PlyProperty& property : element.properties)
                property.is_list ? skip_list(property) : static_cast<void>(rows.scalar(property.type));
        }
    }
    const PlyElement& element = header.elements[vertex];
    std::array<std::size_t, kRoles + 2> place{};  // in a row of the table, plus one
    std::array<double, kRoles + 2> scale{};
    std::size_t width = 0;
    for (const PlyProperty& property : element.properties) {
        const PlyRole role = ply_role_of(property.name);
        if (property.is_list || role == kNoRole || place[role] != 0) continue;
        place[role] = ++width;
        scale[role] = scale_of(role, property.type);
    }
    std::vector<double> table;
    for (std::uint64_t row = 0; row < element.count; ++row) {
        table.resize(table.size() + width);
        double* values = table.data() + table.size() - width;
        for (const PlyProperty& property : element.properties) {
            if (property.is_list) {
                skip_list(property);
                continue;
            }
            const double value = rows.scalar(property.type);
            const PlyRole role = ply_role_of(property.name);
            if (role != kNoRole) values[place[role] - 1] = value;
        }
    }
    RoleColumns roles;
    for (std::size_t role = 0; role < kRoles; ++role)
        if (place[role] != 0) roles[role] = table_column(table, width, place[role] - 1, scale[role]);
    return gather_points(columns_of(roles, element, name));
}

}  // namespace

PointCloud parse_ply_cloud(std::string_view bytes, const std::string& name) {
    const PlyHeader header = parse_ply_header(bytes, name);
    const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                    [](const PlyElement& element) { return element.name == "vertex"; });
    if (found == header.elements.end() || found->properties.empty()) throw InputError(name, "", "has no vertices");
    const auto vertex = static_cast<std::size_t>(found - header.elements.begin());
    if (header.encoding == PlyEncoding::kAscii)
        return read_row_by_row(AsciiPlyRows(bytes, header.data_begin, name), header, vertex, name);
    if (std::none_of(header.elements.begin(), found + 1, has_lists)) return read_in_place(bytes, header, vertex, name);
    if (header.encoding == PlyEncoding::kBinaryBigEndian)
        return read_row_by_row(BinaryPlyRows<std::endian::big>(bytes, header.data_begin, name), header, vertex, name);
    return read_row_by_row(BinaryPlyRows<std::endian::little>(bytes, header.data_begin, name), header, vertex, name);
}

}  // namespace splice
