// Half of a surfel's bytes, for the surfels of point clouds: no line cuts them and their normal does not turn, so that
// 16 bytes hold what can be seen of them. shaders/glsl/include/surfel_record.glsl decodes the same.
//
//   position  3 x 20 bits over -0.5..0.5: within 2^-21 (0.5 mm of a scan 1 km wide) of the point, along each axis
//   normal    octahedral, 2 x 10 bits, the nearest of what those can say: within 0.16 degrees
//   radius    as it is; below 2
//   colour    as it is
//   above, below  as Surfel::extent has them. Epsilon is not stored but follows from them: (1.5 + above + below) radii,
//             what cloud surfels have
//   patch     not stored: blocks of kPackedBlock surfels in a row take its place where something shows patches
#pragma once

#include "preprocess/model_format/model_format.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace splice {

inline constexpr std::uint32_t kPlaceSteps = 1u << 20;
inline constexpr float kPackedEpsilon = 1.5f;  // radii, of a flat disk
inline constexpr std::uint32_t kPackedBlock = 1024;

/// Coordinates within -0.5..0.5, in bits 0..19, 20..39 and 40..59 of the two words; the upper four are 0.
std::array<std::uint32_t, 2> pack_place(const float (&position)[3]);
void unpack_place(const std::uint32_t (&place)[2], float (&position)[3]);

/// `surfel` has no clip and no shading bend; its epsilon and patch are lost.
format::PackedSurfel pack_surfel(const format::Surfel& surfel);

/// Packs to the same bytes. `patch` is what Surfel::patch is to hold.
format::Surfel unpack_surfel(const format::PackedSurfel& packed, std::uint16_t patch);

/// An octahedral normal (octahedral.h) in 2 x `bits` bits, 10 or 12, u in the lower ones, the nearest that there is;
/// and back.
template <unsigned bits>
std::uint32_t shorten_normal(std::uint32_t octahedral);
template <unsigned bits>
std::uint32_t lengthen_normal(std::uint32_t shortened);

}  // namespace splice
