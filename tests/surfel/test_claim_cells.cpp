#include "preprocess/surfel/claim_cells.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace splice;

TEST_CASE("Cells are claimed and marked alike with every width of vectors") {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (std::uint32_t count = 0; count <= 67; ++count) {
        std::vector<float> x(count), y(count), z(count);
        for (std::uint32_t i = 0; i < count; ++i)
            x[i] = unit(random), y[i] = unit(random), z[i] = 0.2f * unit(random);
        const CellRange cells{x.data(), y.data(), z.data(), count};
        std::vector<float> nearest(count, 0.8f), wide_nearest = nearest;
        std::vector<std::uint32_t> owner(count, 99), wide_owner = owner, marks(count, 0), wide_marks = marks;
        for (std::uint32_t s = 0; s < 5; ++s) {
            CoverSite site{};
            site.position = Vec3f(unit(random), unit(random), 0);
            site.normal = Vec3f::UnitZ();
            site.spacing = 0.3f;
            const SiteReach reach(site, 0.9f);
            const float scale = 1 + 0.2f * static_cast<float>(s);
            claim_cells(reach, scale, s, cells, nearest.data(), owner.data(), VectorWidth::k128);
            claim_cells(reach, scale, s, cells, wide_nearest.data(), wide_owner.data(), VectorWidth::k256);
            mark_cells(reach, cells, marks.data(), VectorWidth::k128);
            mark_cells(reach, cells, wide_marks.data(), VectorWidth::k256);
            REQUIRE(nearest == wide_nearest);
            REQUIRE(owner == wide_owner);
            REQUIRE(marks == wide_marks);
            // And as the definition says.
            for (std::uint32_t i = 0; i < count; ++i) {
                float distance2 = 0;
                if (reach.covers(x[i], y[i], z[i], distance2)) REQUIRE(marks[i] == 1);
                if (owner[i] == s) REQUIRE(nearest[i] == distance2 * scale);
            }
        }
        if (count > 20) {
            REQUIRE(std::count(owner.begin(), owner.end(), 99u) < static_cast<std::ptrdiff_t>(count));
            REQUIRE(std::count(marks.begin(), marks.end(), 0u) > 0);
        }
    }
}
