// What the two quality benchmarks share: the cameras that a model is seen from, and telling the user how far they are.
#pragma once

#include "engine/bench/bench_quality.h"

#include <string_view>

namespace splice::bench {

struct NamedCamera {
    std::string name;  // "default", or the direction of the eye like "+x-y"
    Camera camera;
};

std::vector<NamedCamera> bench_cameras(const Box& bounds, const QualityOptions& options);

/// Tells the terminal what is going on; an empty text wipes the line. Nothing where stderr is no terminal.
void show_progress(std::string_view text);

}  // namespace splice::bench
