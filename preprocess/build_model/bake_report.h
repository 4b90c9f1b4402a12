// What splice-bake says about a bake: the --stats JSON and the summary for people.
#pragma once

#include "preprocess/build_model/build_model.h"

#include <string>

namespace splice {

struct BakeResult {
    std::uint64_t drawn_triangles = 0, surfels = 0, file_bytes = 0;
    double seconds_write = 0;
    std::uint64_t peak_rss_bytes = 0;
};

std::string stats_json(const BakeStats& stats, const BakeResult& result);

/// A few lines: what the input was, what repair changed (nonzero counts only), what came out.
std::string summary(const BakeStats& stats, const BakeResult& result);

}  // namespace splice
