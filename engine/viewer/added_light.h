// The light that "Add a light" adds: it shows what the others leave dark, and makes nothing white that was not.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"

namespace splice {

/// Directional, moves with the camera. No white surface becomes brighter than white, or than the brightest one was,
/// whichever is more (a point light counts as if it were as strong everywhere, from where it is to the camera's
/// target).
Light added_light(const Lighting& lighting, const Camera& camera);

}  // namespace splice
