#include "engine/bench/bench_view.h"

#include "tests/reference/comparison.h"

namespace splice::bench {
namespace {

std::string direction_name(const glm::dvec3& direction) {
    std::string name;
    for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0) name += {direction[axis] > 0 ? '+' : '-', static_cast<char>('x' + axis)};
    return name;
}

}  // namespace

std::vector<NamedCamera> bench_cameras(const Box& bounds, const QualityOptions& options) {
    if (options.directions == 1) {
        Framing framing;
        framing.orthographic = options.orthographic;
        return {{"default", frame_camera(bounds, framing, options.width, options.height)}};
    }
    const std::vector<glm::dvec3> all = reference::view_directions();
    std::vector<NamedCamera> cameras;
    for (std::size_t i = 0; i < options.directions; ++i) {
        const glm::dvec3& direction = all[i * all.size() / options.directions];
        cameras.push_back({direction_name(direction), reference::camera_from(bounds, direction, options.width,
                                                                             options.height, options.orthographic)});
    }
    return cameras;
}

}  // namespace splice::bench
