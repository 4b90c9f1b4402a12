// A scene file's look as settings of a frame, and back.
#pragma once

#include "engine/capture/capture.h"
#include "engine/scene/scene_look.h"

namespace splice {

/// Leaves what a look does not say: size, camera, what is wanted beside the picture.
void apply_look(const SceneLook& look, CaptureSettings& settings);
SceneLook look_of(const CaptureSettings& settings);

}  // namespace splice
