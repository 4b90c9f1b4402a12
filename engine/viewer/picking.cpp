#include "engine/viewer/picking.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splice {

namespace {

glm::dvec3 vector_of(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

// A ray in a model's unit-box units; parameters along it are world units.
struct ModelRay {
    glm::dvec3 origin, direction;
};

bool meets_box(const ModelRay& ray, const float (&minimum)[3], const float (&maximum)[3], double nearest) {
    double from = 0, to = nearest;
    for (int axis = 0; axis < 3; ++axis) {
        // Divisions by zero give infinities of the right sign; on a face, NaN, which std::max and std::min pass over.
        const double a = (minimum[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (maximum[axis] - ray.origin[axis]) / ray.direction[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

class ModelPicker {
  public:
    ModelPicker(const ModelView& model, const ModelRay& ray, const PickOptions& options, double nearest)
        : model_(model), ray_(ray), options_(options), nearest_(nearest) {
        const bool baked_two_sided = (model.info->flags & format::kTwoSided) != 0;
        two_sided_ = options.sides == Sides::kAsBaked ? baked_two_sided : options.sides == Sides::kTwoSided;
    }

    std::optional<Hit> run() {
        if (!model_.octree.empty()) visit(0);
        return hit_;
    }

  private:
    void visit(std::uint32_t index) {
        const format::OctreeNode& node = model_.octree[index];
        if (!meets_box(ray_, node.bounds_min, node.bounds_max, nearest_)) return;
        if (node.child_count == 0) {
            for (std::uint32_t patch = node.first_patch; patch < node.first_patch + node.patch_count; ++patch)
                visit_patch(patch);
            return;
        }
        for (std::uint32_t child = node.first_child; child < node.first_child + node.child_count; ++child)
            visit(child);
    }

    void visit_patch(std::uint32_t index) {
        const format::Patch& patch = model_.patches[index];
        if (!meets_box(ray_, patch.bounds_min, patch.bounds_max, nearest_)) return;
        const bool triangles = patch.representation == format::Representation::kTriangles;
        if (triangles ? options_.shown != Shown::kSurfels
                      : options_.shown == Shown::kTriangles && patch.lod_count > 0) {
            visit_triangles(index, patch);
        } else if (!triangles && options_.shown != Shown::kTriangles) {
            visit_surfels(index, patch);
        }
    }

    void visit_triangles(std::uint32_t index, const format::Patch& patch) {
        const format::Lod& finest = model_.lods[patch.first_lod];
        for (std::uint64_t first = finest.first_index; first < finest.first_index + finest.index_count; first += 3) {
            const auto corner = [&](std::uint64_t i) {
                return vector_of(model_.vertices[model_.indices[first + i]].position);
            };
            const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
            const glm::dvec3 normal = glm::cross(ab, ac);
            const double facing = glm::dot(normal, ray_.direction);
            if (facing == 0 || (facing > 0 && !two_sided_)) continue;
            const double distance = glm::dot(normal, a - ray_.origin) / facing;
            if (!(distance > 0 && distance < nearest_)) continue;
            const glm::dvec3 p = ray_.origin + ray_.direction * distance - a;
            const double area = glm::dot(normal, normal);
            const double v = glm::dot(glm::cross(p, ac), normal), w = glm::dot(glm::cross(ab, p), normal);
            if (v < 0 || w < 0 || v + w > area) continue;
            keep(index, format::Representation::kTriangles, first / 3, distance, normal);
        }
    }

    void visit_surfels(std::uint32_t index, const format::Patch& patch) {
        for (std::uint64_t i = patch.first_surfel; i < patch.first_surfel + patch.surfel_count; ++i) {
            const format::Surfel surfel = model_.surfel(i);
            const std::array<float, 3> n = decode_octahedral(surfel.normal);
            const glm::dvec3 normal(n[0], n[1], n[2]), centre = vector_of(surfel.position);
            const double facing = glm::dot(normal, ray_.direction);
            if (facing == 0 || (facing > 0 && !two_sided_)) continue;
            const double distance = glm::dot(normal, centre - ray_.origin) / facing;
            if (!(distance > 0 && distance < nearest_)) continue;
            const glm::dvec3 offset = ray_.origin + ray_.direction * distance - centre;
            const double radius = float_from_half(surfel.radius);
            if (glm::dot(offset, offset) > radius * radius) continue;
            keep(index, format::Representation::kSurfels, i, distance, normal);
        }
    }

    void keep(std::uint32_t index, format::Representation kind, std::uint64_t element, double distance,
              const glm::dvec3& normal) {
        nearest_ = distance;
        hit_ = Hit{
            .patch = index, .kind = kind, .element = element, .distance = distance, .normal = glm::normalize(normal)};
    }

    const ModelView& model_;
    const ModelRay& ray_;
    const PickOptions& options_;
    double nearest_;
    bool two_sided_ = false;
    std::optional<Hit> hit_;
};

}  // namespace

std::optional<Hit> pick(std::span<const PickableModel> models, const Ray& ray, const PickOptions& options) {
    std::optional<Hit> nearest;
    for (std::size_t i = 0; i < models.size(); ++i) {
        const Transform& transform = models[i].transform;
        const format::ModelInfo& info = *models[i].model->info;
        const glm::dmat3 to_source = glm::transpose(transform.rotation);
        const glm::dvec3 offset(info.source_offset[0], info.source_offset[1], info.source_offset[2]);
        const double scale = transform.scale * info.source_scale;
        const ModelRay inside{
            (to_source * (ray.origin - transform.translation) / transform.scale - offset) / info.source_scale,
            to_source * ray.direction / scale};
        const double limit = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
        std::optional<Hit> hit = ModelPicker(*models[i].model, inside, options, limit).run();
        if (!hit) continue;
        hit->instance = i;
        hit->point = ray.origin + ray.direction * hit->distance;
        hit->normal = transform.rotation * hit->normal;
        nearest = hit;
    }
    return nearest;
}

}  // namespace splice
