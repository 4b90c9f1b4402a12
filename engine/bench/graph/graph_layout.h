// Places for a layered drawing: each box above all that depend on it and as near as can be, few crossings, lines that
// pass between boxes (Sugiyama, Tagawa, Toda, "Methods for visual understanding of hierarchical system structures",
// 1981).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace splice::bench {

struct LayoutBox {
    double width = 0;  ///< in
    double x = 0;      ///< out: of the centre
    size_t layer = 0;  ///< out
};

/// A line from a box to one in a lower layer: its ends and where it crosses the layers between.
struct LayoutLine {
    size_t from = 0, to = 0;        ///< in: boxes, from before to
    std::vector<double> x_between;  ///< out: in each layer between the two
};

/// `lines` must lead from lower to higher indices, ordered by where they lead. `gap`: least distance between neighbours
/// of a layer. The leftmost edge comes to 0; returns the width.
double lay_out(std::vector<LayoutBox>& boxes, std::vector<LayoutLine>& lines, double gap);

}  // namespace splice::bench
