#include "preprocess/lod/split_points.h"

#include "preprocess/large_vector.h"
#include "preprocess/lod/point_octree.h"

#include <tbb/parallel_for.h>

#include <array>
#include <numeric>
#include <utility>

namespace splice {
namespace {

// Large nodes are divided by parts of so many points, in parallel.
constexpr std::size_t kPart = 1 << 16;

using Counts = std::array<std::uint32_t, 8>;

class Splitter {
  public:
    explicit Splitter(std::span<const Vec3f> positions)
        : positions_(positions), scratch_(large_vector<std::uint32_t>(positions.size())) {
        split_.order = large_vector<std::uint32_t>(positions.size());
        std::iota(split_.order.begin(), split_.order.end(), 0u);
    }

    // Level by level: the nodes of one in parallel, then their children in the order of their parents.
    PointSplit split() {
        split_.nodes.push_back(node_over(0, static_cast<std::uint32_t>(positions_.size())));
        split_.level_begin = {0, 1};
        for (;;) {
            const std::uint32_t begin = split_.level_begin.end()[-2], end = split_.level_begin.end()[-1];
            std::vector<Counts> counts(end - begin);
            tbb::parallel_for(begin, end, [&](std::uint32_t node) { counts[node - begin] = partition(node); });
            for (std::uint32_t node = begin; node < end; ++node)
                add_children(node, counts[node - begin]);
            if (split_.nodes.size() == end) return std::move(split_);
            split_.level_begin.push_back(static_cast<std::uint32_t>(split_.nodes.size()));
        }
    }

  private:
    static format::PointNode node_over(std::uint32_t first, std::uint32_t count) {
        format::PointNode node{};
        node.first_surfel = first;
        node.surfel_count = count;
        return node;
    }

    // Sorts the node's range by octant about its mean; how many each octant got. None for a leaf.
    Counts partition(std::uint32_t index) {
        const format::PointNode& node = split_.nodes[index];
        Counts counts{};
        if (node.surfel_count <= kPointLeaf) return counts;
        const std::span<std::uint32_t> range = std::span(split_.order).subspan(node.first_surfel, node.surfel_count);
        const std::span<std::uint32_t> sorted = std::span(scratch_).subspan(node.first_surfel, node.surfel_count);
        const std::size_t parts = (range.size() + kPart - 1) / kPart;
        const auto part_of = [&](std::size_t part) {
            return range.subspan(part * kPart, std::min(kPart, range.size() - part * kPart));
        };
        const auto for_each_part = [&](const auto& visit) {
            if (parts == 1) return visit(std::size_t{0});
            tbb::parallel_for(std::size_t{0}, parts, visit);
        };
        // Most nodes are of one part, and small: nothing is allocated for those.
        Vec3d sum_of_one = Vec3d::Zero();
        Counts places_of_one{};
        std::vector<Vec3d> sums_of_many;
        std::vector<Counts> places_of_many;
        if (parts > 1) {
            sums_of_many.assign(parts, Vec3d::Zero());
            places_of_many.assign(parts, Counts{});
        }
        const std::span<Vec3d> sums = parts > 1 ? std::span(sums_of_many) : std::span(&sum_of_one, 1);
        const std::span<Counts> places = parts > 1 ? std::span(places_of_many) : std::span(&places_of_one, 1);
        for_each_part([&](std::size_t part) {
            for (const std::uint32_t point : part_of(part))
                sums[part] += positions_[point].cast<double>();
        });
        const Vec3d mean =
            std::accumulate(sums.begin(), sums.end(), Vec3d(Vec3d::Zero())) / static_cast<double>(range.size());
        const auto octant = [&](std::uint32_t point) {
            const Vec3d p = positions_[point].cast<double>();
            return (p.x() > mean.x() ? 1u : 0u) | (p.y() > mean.y() ? 2u : 0u) | (p.z() > mean.z() ? 4u : 0u);
        };
        for_each_part([&](std::size_t part) {
            for (const std::uint32_t point : part_of(part))
                ++places[part][octant(point)];
        });
        // From how many to where the part's first goes.
        std::uint32_t next = 0;
        for (std::size_t o = 0; o < counts.size(); ++o) {
            const std::uint32_t first = next;
            for (Counts& part : places)
                next += std::exchange(part[o], next);
            counts[o] = next - first;
        }
        for (const std::uint32_t count : counts) {
            // The mean does not separate points that rounding has made one: any halves will do.
            if (count != node.surfel_count) continue;
            return {count / 2, count - count / 2};
        }
        for_each_part([&](std::size_t part) {
            for (const std::uint32_t point : part_of(part))
                sorted[places[part][octant(point)]++] = point;
        });
        for_each_part([&](std::size_t part) {
            std::copy_n(sorted.begin() + static_cast<std::ptrdiff_t>(part * kPart), part_of(part).size(),
                        part_of(part).begin());
        });
        return counts;
    }

    void add_children(std::uint32_t index, const Counts& counts) {
        std::uint32_t first = split_.nodes[index].first_surfel;
        for (const std::uint32_t count : counts) {
            if (count == 0) continue;
            format::PointNode& node = split_.nodes[index];
            if (node.child_count++ == 0) node.first_child = static_cast<std::uint32_t>(split_.nodes.size());
            split_.nodes.push_back(node_over(first, count));
            first += count;
        }
    }

    std::span<const Vec3f> positions_;
    std::vector<std::uint32_t> scratch_;
    PointSplit split_;
};

}  // namespace

PointSplit split_points(std::span<const Vec3f> positions) {
    return Splitter(positions).split();
}

}  // namespace splice
