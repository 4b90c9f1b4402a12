// What the properties of PLY vertices and faces are called in practice.
#pragma once

#include "preprocess/mesh/ply_header.h"

#include <string>

namespace splice {

/// What a scalar property of a vertex or face means; the order is that of a row of values.
enum PlyRole { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV, kRed, kGreen, kBlue, kTextureNumber, kRoles, kNoRole };

PlyRole ply_role_of(const std::string& property);

/// Colours are fractions in floating-point properties, whole ranges in integer ones.
double ply_colour_scale(PlyType type);

}  // namespace splice
