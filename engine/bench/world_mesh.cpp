#include "engine/bench/world_mesh.h"

#include "preprocess/model_format/error.h"
#include "tests/reference/comparison.h"

#include <algorithm>

namespace splice::bench {
namespace {

Vec3d to_eigen(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Vec3d applied(const Transform& transform, const Vec3d& source) {
    return to_eigen(transform.rotation * (glm::dvec3(source.x(), source.y(), source.z()) * transform.scale) +
                    transform.translation);
}

Vec3f turned(const Transform& transform, const Vec3f& normal) {
    return to_eigen(transform.rotation * glm::dvec3(normal.x(), normal.y(), normal.z())).cast<float>();
}

/// Appends `more`, or `fill` for each of its corners where it has none; an attribute that no mesh so far has stays
/// away.
template <typename T>
void append_corners(std::vector<T>& all, std::size_t corners_before, const std::vector<T>& more, std::size_t corners,
                    const T& fill) {
    if (all.empty() && more.empty()) return;
    all.resize(corners_before, fill);
    all.insert(all.end(), more.begin(), more.end());
    all.resize(corners_before + corners, fill);
}

void append(IndexedMesh& world, const IndexedMesh& mesh, const Transform& transform) {
    const auto first_position = static_cast<std::uint32_t>(world.positions.size());
    const auto first_material = static_cast<std::uint32_t>(world.materials.size());
    const auto first_image = static_cast<std::uint32_t>(world.images.size());
    const std::size_t before = 3 * world.triangles.size(), corners = 3 * mesh.triangles.size();
    for (const Vec3f& position : mesh.positions)
        world.positions.push_back(
            applied(transform, position.cast<double>() * mesh.source_scale + mesh.source_offset).cast<float>());
    for (Triangle triangle : mesh.triangles) {
        for (std::uint32_t& index : triangle)
            index += first_position;
        world.triangles.push_back(triangle);
    }
    for (const Vec3f& normal : mesh.corner_normals)
        world.corner_normals.push_back(turned(transform, normal));
    append_corners(world.corner_uvs, before, mesh.corner_uvs, corners, Vec2f(Vec2f::Zero()));
    append_corners(world.corner_colours, before, mesh.corner_colours, corners, kWhite);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        world.triangle_material.push_back(first_material +
                                          (mesh.triangle_material.empty() ? 0 : mesh.triangle_material[t]));
    for (MeshMaterial material : mesh.materials) {
        if (material.image != kNoImage) material.image += first_image;
        world.materials.push_back(material);
    }
    world.images.insert(world.images.end(), mesh.images.begin(), mesh.images.end());
}

IndexedMesh mesh_of(const SceneModel& model, const std::filesystem::path& path, std::size_t index) {
    const std::string place = "/models/" + std::to_string(index);
    if (const auto* shape = std::get_if<ShapeDescription>(&model.source)) {
        RepairReport report;
        return repair_mesh(make_shape(*shape, path.string(), place + "/shape"), {}, report, shape->kind);
    }
    const auto& file = std::get<std::filesystem::path>(model.source);
    if (file.extension() == ".splice")
        throw InputError(path.string(), file == path ? "" : place + "/file",
                         "expected a mesh: a baked model does not tell what it was baked from");
    return reference::load_mesh(file);
}

}  // namespace

IndexedMesh world_mesh(const LoadedScene& loaded, const std::filesystem::path& path) {
    IndexedMesh world;
    for (std::size_t i = 0; i < loaded.scene.instances.size(); ++i)
        append(world, mesh_of(loaded.description.models[i], path, i), loaded.scene.instances[i].transform);
    return world;
}

IndexedMesh in_source_units(IndexedMesh mesh) {
    for (Vec3f& position : mesh.positions)
        position = (position.cast<double>() * mesh.source_scale + mesh.source_offset).cast<float>();
    mesh.source_scale = 1;
    mesh.source_offset = Vec3d::Zero();
    return mesh;
}

}  // namespace splice::bench
