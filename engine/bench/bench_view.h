// What the two quality benchmarks share: the cameras that a model is seen from.
#pragma once

#include "engine/bench/bench_quality.h"
#include "engine/bench/report/progress.h"

#include <string>
#include <vector>

namespace splice::bench {

struct NamedCamera {
    std::string name;  // "default", or the direction of the eye like "+x-y"
    Camera camera;
};

std::vector<NamedCamera> bench_cameras(const Box& bounds, const QualityOptions& options);

}  // namespace splice::bench
