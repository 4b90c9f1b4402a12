#include "engine/capture/bake_of_scene.h"

#include <algorithm>

namespace splice {

namespace {

// Both enumerations have the same order.
static_assert(static_cast<int>(SceneRepresentation::kTriangles) == static_cast<int>(ForcedRepresentation::kTriangles) &&
              static_cast<int>(SceneRepresentation::kSurfels) == static_cast<int>(ForcedRepresentation::kSurfels) &&
              static_cast<int>(SceneSelection::kThesis) == static_cast<int>(Selection::kThesis));

}  // namespace

BakeOptions bake_of(const SceneModel& model) {
    BakeOptions options;
    options.cluster.representation = static_cast<ForcedRepresentation>(model.representation);
    options.cluster.selection = static_cast<Selection>(model.selection);
    options.cluster.triangle_share = model.triangle_share;
    options.sampling.thesis_c = model.sampling;
    if (model.max_spacing) {
        options.sampling.h_max = *model.max_spacing;
        options.sampling.h_min = std::min(options.sampling.h_min, *model.max_spacing);
    }
    return options;
}

void describe_bake(const BakeOptions& options, SceneModel& model) {
    model.representation = static_cast<SceneRepresentation>(options.cluster.representation);
    model.selection = static_cast<SceneSelection>(options.cluster.selection);
    model.triangle_share.reset();
    if (model.representation == SceneRepresentation::kHybrid) model.triangle_share = options.cluster.triangle_share;
    model.sampling = options.sampling.thesis_c;
    model.max_spacing.reset();
    if (options.sampling.h_max != SamplingOptions{}.h_max) model.max_spacing = options.sampling.h_max;
    model.bake_members.clear();
    const auto say = [&](const char* name, bool said) {
        if (said) model.bake_members.emplace_back(name);
    };
    say("representation", model.representation != SceneRepresentation::kHybrid);
    say("selection", model.selection != SceneSelection::kGeometric);
    say("triangle_share", model.triangle_share.has_value());
    say("sampling", model.sampling.has_value());
    say("max_spacing", model.max_spacing.has_value());
}

}  // namespace splice
