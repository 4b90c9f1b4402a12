#include "preprocess/cluster/neighbourhood.h"
#include "preprocess/cluster/roughness.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

using namespace splice;

namespace {

std::vector<Cell> random_cells(std::size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Cell> cells(count);
    for (Cell& cell : cells) {
        cell.position = 1.3f * kRoughnessRadius * Vec3f(unit(random), unit(random), unit(random));
        cell.direction = (Vec3f::UnitZ() + 0.7f * Vec3f(unit(random), unit(random), unit(random))).normalized();
        cell.area = 0.5f + 0.4f * unit(random);
        cell.normal_sum = 0.9f * cell.area * cell.direction;
        cell.triangles = 1.5f + unit(random);
    }
    return cells;
}

/// All cells as one run.
std::vector<Neighbourhood> around(const std::vector<Cell>& cells, std::size_t centres, VectorWidth widest) {
    CellRuns runs;
    runs[0] = cells;
    std::vector<Neighbourhood> result(centres);
    look_around(runs, {cells.data(), centres}, result.data(), widest);
    return result;
}

}  // namespace

TEST_CASE("Neighbourhoods are the same with every width of vectors") {
    const std::vector<Cell> cells = random_cells(300);
    for (std::size_t centres = 1; centres <= 33; ++centres) {
        const auto narrow = around(cells, centres, VectorWidth::k128), wide = around(cells, centres, VectorWidth::k256);
        REQUIRE(std::memcmp(narrow.data(), wide.data(), centres * sizeof(Neighbourhood)) == 0);
    }
}

TEST_CASE("Neighbourhoods hold what is within the radius, and of the sheet what faces the same way") {
    const std::vector<Cell> cells = random_cells(300);
    const auto result = around(cells, cells.size(), VectorWidth::k256);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        Vec3d ball = Vec3d::Zero(), sheet = Vec3d::Zero();
        double ball_area = 0, sheet_area = 0;
        for (const Cell& cell : cells) {
            if ((cell.position - cells[i].position).norm() > kRoughnessRadius) continue;
            ball += cell.normal_sum.cast<double>();
            ball_area += static_cast<double>(cell.area);
            if (cell.direction.dot(cells[i].direction) < 0.8660254f) continue;
            sheet += cell.normal_sum.cast<double>();
            sheet_area += static_cast<double>(cell.area);
        }
        CHECK(static_cast<double>(result[i].ball) == Approx(std::sqrt(2 * (1 - ball.norm() / ball_area))).margin(2e-3));
        CHECK(static_cast<double>(result[i].sheet) ==
              Approx(std::sqrt(2 * (1 - sheet.norm() / sheet_area))).margin(2e-3));
    }
}
