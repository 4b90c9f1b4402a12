#include "engine/scene/frame_budget.h"

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

constexpr double kFinest = 1.0 / 16, kCoarsest = 1024;  // pixels
constexpr double kCloseEnough = 0.9;                    // share of the budget
constexpr int kMostHalvings = 10;

}  // namespace

BudgetedDraws build_within_budget(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                  const DrawListOptions& options, double budget_ms) {
    const auto build = [&](double tau) {
        DrawListOptions coarser = options;
        coarser.tau = tau;
        return BudgetedDraws{tau, build_draw_list(scene, camera, width, height, coarser)};
    };
    BudgetedDraws best = build(options.tau);
    if (best.draws.predicted_ms <= budget_ms) return best;
    double too_fine = std::max(options.tau, kFinest / 2);
    do {
        best = build(2 * too_fine);
        if (best.draws.predicted_ms <= budget_ms) break;
        too_fine *= 2;
    } while (too_fine < kCoarsest);
    if (best.draws.predicted_ms > budget_ms) return best;
    for (int i = 0; i < kMostHalvings && best.draws.predicted_ms < kCloseEnough * budget_ms; ++i) {
        BudgetedDraws between = build(std::sqrt(too_fine * best.tau));
        if (between.draws.predicted_ms <= budget_ms) {
            best = std::move(between);
        } else {
            too_fine = between.tau;
        }
    }
    return best;
}

}  // namespace splice
