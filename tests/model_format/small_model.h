// A small model with every kind of section filled, made by hand: two patches (one of triangles, one of surfels), three
// levels, an octree of three nodes, a merge tree, a texture.
#pragma once

#include "preprocess/model_format/model.h"

namespace splice::test {

Model small_model();

}  // namespace splice::test
