// Mip chains of a model's textures: box filter in linear light, colours weighted by alpha so that transparent texels do
// not bleed into opaque ones.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstddef>
#include <vector>

namespace splice {

/// The next smaller level: each side halved rounding down, at least 1. Where a side is odd, a texel's box covers
/// fractions of the level above. Deterministic for any thread count.
Image halve_image(const Image& image);

/// All levels down to 1x1, the largest first, one after another (format::SectionKind::kTexels).
std::vector<std::byte> build_mip_chain(const Image& image);

}  // namespace splice
