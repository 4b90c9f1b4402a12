#include "preprocess/mesh/ply_roles.h"

#include <array>
#include <string_view>
#include <utility>

namespace splice {

PlyRole ply_role_of(const std::string& property) {
    static constexpr std::array<std::pair<std::string_view, PlyRole>, 26> kNames = {{
        {"x", kX},
        {"y", kY},
        {"z", kZ},
        {"nx", kNormalX},
        {"ny", kNormalY},
        {"nz", kNormalZ},
        {"normal_x", kNormalX},
        {"normal_y", kNormalY},
        {"normal_z", kNormalZ},
        {"u", kU},
        {"v", kV},
        {"s", kU},
        {"t", kV},
        {"texture_u", kU},
        {"texture_v", kV},
        {"red", kRed},
        {"green", kGreen},
        {"blue", kBlue},
        {"r", kRed},
        {"g", kGreen},
        {"b", kBlue},
        {"diffuse_red", kRed},
        {"diffuse_green", kGreen},
        {"diffuse_blue", kBlue},
        {"texnumber", kTextureNumber},
        {"texture_number", kTextureNumber},
    }};
    for (const auto& [name, role] : kNames) {
        if (property == name) return role;
    }
    return kNoRole;
}

double ply_colour_scale(PlyType type) {
    switch (type) {
        case PlyType::kFloat32:
        case PlyType::kFloat64:
            return 1.0;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 1.0 / 65535;
        default:
            return 1.0 / 255;
    }
}

}  // namespace splice
