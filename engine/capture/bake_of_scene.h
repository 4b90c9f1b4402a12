// How a scene file's model is baked: its members as options of the bake, and back.
#pragma once

#include "engine/scene/scene_file.h"
#include "preprocess/build_model/build_model.h"

namespace splice {

BakeOptions bake_of(const SceneModel& model);

/// What of the options a scene file can say, as members of `model`: those that are not the default.
void describe_bake(const BakeOptions& options, SceneModel& model);

}  // namespace splice
