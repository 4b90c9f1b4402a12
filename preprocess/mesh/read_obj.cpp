#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/obj_materials.h"
#include "preprocess/mesh/obj_text.h"
#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/model_format/error.h"

#include <tiny_obj_loader.h>

#include <istream>
#include <streambuf>

namespace splice {
namespace {

/// Lets an istream read a string in place.
class ViewBuffer : public std::streambuf {
  public:
    explicit ViewBuffer(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
};

/// What the callbacks gather. OBJ indices are 1-based, 0 when absent, negative relative to what has been read so far.
struct Gatherer {
    explicit Gatherer(const CompanionFiles& companions) : materials(companions) { mesh.polygon_begin.push_back(0); }

    static std::uint32_t resolve(int index, std::size_t count_so_far) {
        if (index > 0) return static_cast<std::uint32_t>(index) - 1;
        const auto back = static_cast<std::size_t>(-static_cast<std::int64_t>(index));
        return index < 0 && back <= count_so_far ? static_cast<std::uint32_t>(count_so_far - back) : kInvalidIndex;
    }

    void face(const tinyobj::index_t* corners, int count) {
        for (int i = 0; i < count; ++i) {
            mesh.corner_position.push_back(resolve(corners[i].vertex_index, mesh.positions.size()));
            corner_normal.push_back(resolve(corners[i].normal_index, normals.size()));
            corner_uv.push_back(resolve(corners[i].texcoord_index, uvs.size()));
        }
        mesh.polygon_begin.push_back(mesh.corner_position.size());
        // Faces before any usemtl are white, whatever the first library says.
        if (material == kInvalidIndex) material = materials.use("", mesh);
        mesh.polygon_material.push_back(material);
    }

    SourceMesh mesh;
    ObjMaterials materials;
    std::uint32_t material = kInvalidIndex;
    std::vector<Vec3f> normals;
    std::vector<Vec2f> uvs;
    std::vector<std::uint32_t> corner_normal, corner_uv;
};

/// tinyobjloader hands over the names of libraries here; the materials themselves are kept by ObjMaterials, because the
/// loader's own list must not be empty when it is passed on.
class LibraryReader : public tinyobj::MaterialReader {
  public:
    explicit LibraryReader(Gatherer& gatherer) : gatherer_(gatherer) {}
    bool operator()(const std::string& names, std::vector<tinyobj::material_t>* /*materials*/,
                    std::map<std::string, int>* /*map*/, std::string* /*warning*/, std::string* /*error*/) override {
        gatherer_.materials.load_libraries(names, gatherer_.mesh);
        return false;
    }

  private:
    Gatherer& gatherer_;
};

tinyobj::callback_t callbacks() {
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* user, double x, double y, double z, double /*w*/) {
        static_cast<Gatherer*>(user)->mesh.positions.emplace_back(x, y, z);
    };
    callback.normal_cb = [](void* user, double x, double y, double z) {
        static_cast<Gatherer*>(user)->normals.push_back(Vec3d(x, y, z).cast<float>());
    };
    callback.texcoord_cb = [](void* user, double u, double v, double /*w*/) {
        static_cast<Gatherer*>(user)->uvs.push_back(Vec2d(u, 1 - v).cast<float>());
    };
    callback.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        static_cast<Gatherer*>(user)->face(corners, count);
    };
    callback.usemtl_cb = [](void* user, const char* name, int /*id*/) {
        auto* gatherer = static_cast<Gatherer*>(user);
        gatherer->material = gatherer->materials.use(name, gatherer->mesh);
    };
    return callback;
}

template <class Value>
std::vector<Value> look_up(const std::vector<Value>& values, const Value& missing,
                           const std::vector<std::uint32_t>& indices) {
    std::vector<Value> corners;
    if (values.empty()) return corners;
    corners.reserve(indices.size());
    for (const std::uint32_t index : indices)
        corners.push_back(index < values.size() ? values[index] : missing);
    return corners;
}

std::vector<std::uint32_t> to_colours(const std::vector<std::array<float, 3>>& rgb) {
    float largest = 0;
    for (const auto& c : rgb) {
        for (const float component : c) {
            if (component > largest) largest = component;
        }
    }
    const double scale = largest > 1 ? 1.0 / 255 : 1.0;
    std::vector<std::uint32_t> colours;
    colours.reserve(rgb.size());
    for (const auto& c : rgb)
        colours.push_back(pack_colour(c[0] * scale, c[1] * scale, c[2] * scale));
    return colours;
}

/// When not one face can be used, the line of the first says more than a count.
void require_valid_face(const SourceMesh& mesh, const std::vector<std::uint32_t>& face_lines, const std::string& name) {
    const std::size_t faces = mesh.polygon_begin.size() - 1;
    for (std::size_t f = 0; f < faces; ++f) {
        bool valid = mesh.polygon_begin[f + 1] - mesh.polygon_begin[f] >= 3;
        for (std::size_t i = mesh.polygon_begin[f]; i < mesh.polygon_begin[f + 1]; ++i) {
            valid &= mesh.corner_position[i] < mesh.positions.size();
        }
        if (valid) return;
    }
    if (faces == 0 || face_lines.empty()) return;
    throw InputError(name, "line " + std::to_string(face_lines.front()),
                     "no face of the file can be used, this is the first; expected at least three indices of the " +
                         std::to_string(mesh.positions.size()) + " vertices");
}

}  // namespace

SourceMesh parse_obj(std::string_view bytes, const std::string& name, const CompanionFiles& companions) {
    ObjText text = tidy_obj_text(bytes);
    ViewBuffer buffer(text.statements);
    std::istream stream(&buffer);
    Gatherer gatherer(companions);
    LibraryReader libraries(gatherer);
    tinyobj::LoadObjWithCallback(stream, callbacks(), &gatherer, &libraries);

    SourceMesh& mesh = gatherer.mesh;
    require_valid_face(mesh, text.face_lines, name);
    mesh.corner_normals = look_up<Vec3f>(gatherer.normals, Vec3f::Zero(), gatherer.corner_normal);
    mesh.corner_uvs = look_up<Vec2f>(gatherer.uvs, Vec2f::Zero(), gatherer.corner_uv);
    VertexAttributes attributes;
    attributes.colours = to_colours(text.vertex_colours);
    expand_vertex_attributes(attributes, mesh);
    return std::move(mesh);
}

}  // namespace splice
