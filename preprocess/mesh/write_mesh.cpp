#include "preprocess/mesh/write_mesh.h"

#include "preprocess/model_format/error.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <tuple>

namespace splice {
namespace {

/// Writes a whole file or throws.
void write_file(const std::filesystem::path& path, std::span<const char> bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw SystemError(path.string() + ": cannot be written");
}

/// The shortest text that reads back as the same number, whatever the locale.
template <class Number>
void append(std::string& text, Number number) {
    std::array<char, 40> buffer{};
    text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr);
}

double fraction(std::uint32_t colour, int component) {
    return ((colour >> (8 * component)) & 0xff) / 255.0;
}

/// Numbers the distinct values of a corner array in order of first appearance.
template <std::size_t N>
class Distinct {
  public:
    std::uint32_t index(const std::array<float, N>& value) {
        std::array<std::uint32_t, N> bits{};
        for (std::size_t i = 0; i < N; ++i)
            bits[i] = std::bit_cast<std::uint32_t>(value[i]);
        const auto [entry, is_new] = indices_.try_emplace(bits, static_cast<std::uint32_t>(values_.size()));
        if (is_new) values_.push_back(value);
        return entry->second;
    }
    void write(std::string& text, const char* keyword) const {
        for (const auto& value : values_) {
            text += keyword;
            for (const float component : value) {
                text += ' ';
                append(text, component);
            }
            text += '\n';
        }
    }

  private:
    std::map<std::array<std::uint32_t, N>, std::uint32_t> indices_;
    std::vector<std::array<float, N>> values_;
};

void write_ppm(const Image& image, const std::filesystem::path& path) {
    std::string bytes = "P6\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        for (std::size_t c = 0; c < 3; ++c)
            bytes += static_cast<char>(image.rgba[i + c]);
    }
    write_file(path, bytes);
}

std::string material_name(const SourceMesh& mesh, std::size_t index) {
    return mesh.materials[index].name.empty() ? "material_" + std::to_string(index) : mesh.materials[index].name;
}

void write_materials(const SourceMesh& mesh, const std::filesystem::path& obj_path) {
    const std::string stem = obj_path.stem().string();
    std::string text;
    for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
        const MeshMaterial& material = mesh.materials[m];
        text += "newmtl " + material_name(mesh, m) + "\nKd";
        for (int c = 0; c < 3; ++c) {
            text += ' ';
            append(text, fraction(material.diffuse, c));
        }
        text += '\n';
        if (material.image < mesh.images.size()) {
            text += "map_Kd " + stem + "_" + std::to_string(material.image) + ".ppm\n";
        }
    }
    write_file(obj_path.parent_path() / (stem + ".mtl"), text);
    for (std::size_t i = 0; i < mesh.images.size(); ++i) {
        write_ppm(mesh.images[i], obj_path.parent_path() / (stem + "_" + std::to_string(i) + ".ppm"));
    }
}

}  // namespace

void write_obj(const SourceMesh& mesh, const std::filesystem::path& path) {
    // OBJ has colours at vertices only: the last corner at a vertex decides.
    std::vector<std::uint32_t> vertex_colour;
    if (!mesh.corner_colours.empty()) {
        vertex_colour.assign(mesh.positions.size(), kWhite);
        for (std::size_t i = 0; i < mesh.corner_position.size(); ++i) {
            vertex_colour[mesh.corner_position[i]] = mesh.corner_colours[i];
        }
    }
    std::string text;
    if (!mesh.materials.empty()) text += "mtllib " + path.stem().string() + ".mtl\n";
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        text += 'v';
        for (const double coordinate : mesh.positions[v]) {
            text += ' ';
            append(text, coordinate);
        }
        for (int c = 0; c < 3 && !vertex_colour.empty(); ++c) {
            text += ' ';
            append(text, static_cast<float>(fraction(vertex_colour[v], c)));
        }
        text += '\n';
    }
    Distinct<2> uvs;
    Distinct<3> normals;
    std::string faces;
    std::size_t material_in_use = mesh.materials.size();
    for (std::size_t p = 0; p + 1 < mesh.polygon_begin.size(); ++p) {
        const std::size_t material = mesh.polygon_material.empty() ? 0 : mesh.polygon_material[p];
        if (material < mesh.materials.size() && material != material_in_use) {
            faces += "usemtl " + material_name(mesh, material) + "\n";
            material_in_use = material;
        }
        faces += 'f';
        for (std::uint64_t i = mesh.polygon_begin[p]; i < mesh.polygon_begin[p + 1]; ++i) {
            faces += ' ';
            append(faces, mesh.corner_position[i] + std::uint64_t{1});
            if (mesh.corner_uvs.empty() && mesh.corner_normals.empty()) continue;
            faces += '/';
            // v grows upwards in OBJ.
            if (!mesh.corner_uvs.empty())
                append(faces, uvs.index({mesh.corner_uvs[i].x(), 1 - mesh.corner_uvs[i].y()}) + 1);
            if (mesh.corner_normals.empty()) continue;
            const Vec3f& n = mesh.corner_normals[i];
            faces += '/';
            append(faces, normals.index({n.x(), n.y(), n.z()}) + 1);
        }
        faces += '\n';
    }
    uvs.write(text, "vt");
    normals.write(text, "vn");
    text += faces;
    write_file(path, text);
    if (!mesh.materials.empty()) write_materials(mesh, path);
}

void write_ply(const SourceMesh& mesh, const std::filesystem::path& path) {
    static_assert(std::endian::native == std::endian::little, "binary rows are written as they lie");
    const bool normals = !mesh.corner_normals.empty(), colours = !mesh.corner_colours.empty();
    using NormalBits = std::array<std::uint32_t, 3>;
    std::map<std::tuple<std::uint32_t, std::uint32_t, NormalBits>, std::int32_t> index_of;  // position, colour, normal
    std::string vertices, faces;
    const auto put = [](std::string& bytes, const auto& value) {
        std::array<char, sizeof value> raw{};
        std::memcpy(raw.data(), &value, sizeof value);
        bytes.append(raw.data(), raw.size());
    };
    for (std::size_t p = 0; p + 1 < mesh.polygon_begin.size(); ++p) {
        const std::uint64_t corners = mesh.polygon_begin[p + 1] - mesh.polygon_begin[p];
        if (corners > 255)
            throw Error(path.string() + ": a polygon of " + std::to_string(corners) + " corners does not fit");
        faces += static_cast<char>(corners);
        for (std::uint64_t i = mesh.polygon_begin[p]; i < mesh.polygon_begin[p + 1]; ++i) {
            const std::uint32_t colour = colours ? mesh.corner_colours[i] : 0;
            NormalBits normal_bits{};
            for (std::size_t k = 0; k < 3 && normals; ++k) {
                normal_bits[k] = std::bit_cast<std::uint32_t>(mesh.corner_normals[i][static_cast<int>(k)]);
            }
            const auto [entry, is_new] = index_of.try_emplace({mesh.corner_position[i], colour, normal_bits},
                                                              static_cast<std::int32_t>(index_of.size()));
            if (is_new) {
                for (const double coordinate : mesh.positions[mesh.corner_position[i]]) {
                    put(vertices, static_cast<float>(coordinate));
                }
                if (normals) put(vertices, normal_bits);
                if (colours) put(vertices, colour);
            }
            put(faces, entry->second);
        }
    }
    std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(index_of.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
    if (normals) file += "property float nx\nproperty float ny\nproperty float nz\n";
    if (colours) file += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    file += "element face " + std::to_string(mesh.polygon_begin.size() - 1) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
    write_file(path, file + vertices + faces);
}

}  // namespace splice
