// Holding a frame time instead of an error: how coarse a frame has to be to be drawn in so many milliseconds.
#pragma once

#include "engine/scene/draw_list.h"

namespace splice {

struct BudgetedDraws {
    double tau = 0;  // pixels; DrawListOptions::tau where that is coarse enough
    DrawList draws;
};

/// The draw list of the least tau, not below the options', that DrawListOptions::costs predict to take no longer; to
/// within a tenth of the budget where the model has levels so fine. If none is coarse enough, the coarsest.
/// Nothing is measured: the same arguments, the same list.
BudgetedDraws build_within_budget(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                  const DrawListOptions& options, double budget_ms);

}  // namespace splice
