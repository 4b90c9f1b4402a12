// The engine's lighting model in C++, written from its description and not from its shader: ambient + Lambert,
// highlights and a rim where asked for. shaders/glsl/include/lighting.glsl is the other one; test_lighting_twin.cpp
// holds the two together through rendered frames.
#pragma once

#include "engine/scene/scene.h"
#include "tests/reference/reference_scene.h"

namespace splice::reference {

/// Lights the mesh's surface points for `camera`. Two-sided surfaces show the side that is looked at.
Shader lighting_twin(const Lighting& lighting, const IndexedMesh& mesh, const Camera& camera, bool two_sided);

}  // namespace splice::reference
