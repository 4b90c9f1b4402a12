#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/ply_header.h"
#include "preprocess/mesh/ply_roles.h"
#include "preprocess/mesh/ply_rows.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>

namespace splice {
namespace {

class PlyParser {
  public:
    PlyParser(std::string_view bytes, const std::string& name, const CompanionFiles& companions)
        : bytes_(bytes), name_(name), companions_(companions) {
        mesh_.polygon_begin.push_back(0);
    }

    SourceMesh parse() {
        const PlyHeader header = parse_ply_header(bytes_, name_);
        switch (header.encoding) {
            case PlyEncoding::kAscii:
                rows(header, AsciiPlyRows(bytes_, header.data_begin, name_));
                break;
            case PlyEncoding::kBinaryLittleEndian:
                rows(header, BinaryPlyRows<std::endian::little>(bytes_, header.data_begin, name_));
                break;
            case PlyEncoding::kBinaryBigEndian:
                rows(header, BinaryPlyRows<std::endian::big>(bytes_, header.data_begin, name_));
                break;
        }
        expand_vertex_attributes(vertex_, mesh_);
        if (!face_colours_.empty() && mesh_.corner_colours.empty()) {
            mesh_.corner_colours = expand_polygon_values(face_colours_, kWhite, mesh_);
        }
        if (!mesh_.corner_uvs.empty()) mesh_.corner_uvs.resize(mesh_.corner_position.size(), Vec2f::Zero());
        for (const std::string& file : header.texture_files)
            add_image_material(file, companions_, mesh_);
        if (!face_textures_.empty()) {
            mesh_.polygon_material = std::move(face_textures_);
            mesh_.polygon_material.resize(mesh_.polygon_begin.size() - 1);
        }
        return std::move(mesh_);
    }

  private:
    enum class List { kIndices, kUvs, kStrips, kNone };

    /// An element's properties with their meaning looked up once.
    struct Column {
        PlyProperty property;
        PlyRole role = kNoRole;
        List list = List::kNone;
        double scale = 1;
    };

    static std::vector<Column> columns_of(const PlyElement& element) {
        std::vector<Column> columns;
        for (const PlyProperty& property : element.properties) {
            Column column{property, kNoRole, List::kNone, 1};
            const std::string& p = property.name;
            if (!property.is_list) {
                column.role = ply_role_of(p);
                if (column.role >= kRed && column.role <= kBlue) column.scale = ply_colour_scale(property.type);
            } else if (p == "vertex_indices" || p == "vertex_index") {
                column.list = element.name == "tristrips" ? List::kStrips : List::kIndices;
            } else if (p == "texcoord") {
                column.list = List::kUvs;
            }
            columns.push_back(std::move(column));
        }
        return columns;
    }

    template <class Rows>
    void rows(const PlyHeader& header, Rows source) {
        for (const PlyElement& element : header.elements) {
            if (element.properties.empty()) continue;  // such rows take no bytes
            const std::vector<Column> columns = columns_of(element);
            std::array<bool, kRoles + 2> has{};
            for (const Column& column : columns)
                has[column.role] = true;
            const bool is_vertex = element.name == "vertex";
            const bool is_face = element.name == "face" || element.name == "tristrips";
            if (is_vertex && !(has[kX] && has[kY] && has[kZ])) {
                throw InputError(name_, element.where(), "the vertices have no properties x, y and z");
            }
            for (std::uint64_t row = 0; row < element.count; ++row) {
                values_.fill(0);
                indices_.clear();
                uvs_.clear();
                for (const Column& column : columns) {
                    if (column.property.is_list) {
                        list(column, source);
                    } else {
                        const double value = source.scalar(column.property.type);
                        if (column.role != kNoRole) values_[column.role] = value * column.scale;
                    }
                }
                if (is_vertex) {
                    add_vertex(has);
                } else if (is_face) {
                    add_faces(has, element.name == "tristrips");
                }
            }
        }
    }

    template <class Rows>
    void list(const Column& column, Rows& source) {
        const double length = source.scalar(column.property.count_type);
        if (!(length >= 0) || length > static_cast<double>(source.scalars_left(column.property.type))) {
            throw InputError(name_, source.where(), "list of impossible length");
        }
        std::vector<double>* into = column.list == List::kUvs    ? &uvs_
                                    : column.list == List::kNone ? nullptr
                                                                 : &indices_;
        for (auto left = static_cast<std::size_t>(length); left > 0; --left) {
            const double value = source.scalar(column.property.type);
            if (into) into->push_back(value);
        }
    }

    void add_vertex(const std::array<bool, kRoles + 2>& has) {
        const auto& v = values_;
        mesh_.positions.emplace_back(v[kX], v[kY], v[kZ]);
        if (has[kNormalX] && has[kNormalY] && has[kNormalZ]) {
            vertex_.normals.push_back(Vec3d(v[kNormalX], v[kNormalY], v[kNormalZ]).cast<float>());
        }
        if (has[kU] && has[kV]) vertex_.uvs.push_back(Vec2d(v[kU], 1 - v[kV]).cast<float>());
        if (has[kRed] && has[kGreen] && has[kBlue]) {
            vertex_.colours.push_back(pack_colour(v[kRed], v[kGreen], v[kBlue]));
        }
    }

    void add_faces(const std::array<bool, kRoles + 2>& has, bool strips) {
        const std::size_t polygons_before = mesh_.polygon_begin.size();
        if (strips) {
            add_strips();
        } else {
            add_polygon();
        }
        const std::size_t added = mesh_.polygon_begin.size() - polygons_before;
        if (has[kRed] && has[kGreen] && has[kBlue]) {
            face_colours_.insert(face_colours_.end(), added,
                                 pack_colour(values_[kRed], values_[kGreen], values_[kBlue]));
        }
        if (has[kTextureNumber]) face_textures_.insert(face_textures_.end(), added, to_index(values_[kTextureNumber]));
    }

    void add_polygon() {
        for (const double index : indices_)
            mesh_.corner_position.push_back(to_index(index));
        if (!uvs_.empty() && uvs_.size() == 2 * indices_.size()) {
            mesh_.corner_uvs.resize(mesh_.corner_position.size() - indices_.size(), Vec2f::Zero());
            for (std::size_t i = 0; i < uvs_.size(); i += 2) {
                mesh_.corner_uvs.push_back(Vec2d(uvs_[i], 1 - uvs_[i + 1]).cast<float>());
            }
        }
        mesh_.polygon_begin.push_back(mesh_.corner_position.size());
    }

    /// -1 starts a new strip; every second triangle of a strip is wound the other way; triangles with a repeated vertex
    /// only steer the strip.
    void add_strips() {
        std::size_t start = 0;
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            if (indices_[i] < 0) {
                start = i + 1;
            } else if (i >= start + 2) {
                const bool odd = (i - start) % 2 != 0;
                const double a = indices_[i - 2], b = indices_[i - 1], c = indices_[i];
                if (a == b || b == c || a == c) continue;
                for (const double index : {odd ? b : a, odd ? a : b, c}) {
                    mesh_.corner_position.push_back(to_index(index));
                }
                mesh_.polygon_begin.push_back(mesh_.corner_position.size());
            }
        }
    }

    std::string_view bytes_;
    const std::string& name_;
    const CompanionFiles& companions_;
    SourceMesh mesh_;
    VertexAttributes vertex_;
    std::vector<std::uint32_t> face_colours_, face_textures_;
    std::array<double, kRoles> values_{};
    std::vector<double> indices_, uvs_;
};

}  // namespace

SourceMesh parse_ply(std::string_view bytes, const std::string& name, const CompanionFiles& companions) {
    return PlyParser(bytes, name, companions).parse();
}

}  // namespace splice
