// The uniform scale and shift that bring a mesh into the unit box (Ni 2005, 4.2): longest side 1, centred at the
// origin.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <algorithm>
#include <limits>

namespace splice {

/// unit = (source - centre) / scale.
class UnitBox {
  public:
    void include(const Vec3d& p) {
        low_ = low_.cwiseMin(p);
        high_ = high_.cwiseMax(p);
    }
    /// 0 if nothing or one point was included.
    double scale() const { return std::max(0.0, (high_ - low_).maxCoeff()); }
    Vec3d centre() const { return low_ / 2 + high_ / 2; }
    Vec3d to_unit(const Vec3d& p) const { return (p - centre()) / scale(); }
    bool operator==(const UnitBox& other) const { return low_ == other.low_ && high_ == other.high_; }

  private:
    Vec3d low_ = Vec3d::Constant(std::numeric_limits<double>::infinity());
    Vec3d high_ = Vec3d::Constant(-std::numeric_limits<double>::infinity());
};

}  // namespace splice
