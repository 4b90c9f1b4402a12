#include "preprocess/cloud/unit_cloud.h"

#include "preprocess/cloud/compact_blocks.h"
#include "preprocess/cloud/near_block.h"
#include "preprocess/large_vector.h"
#include "preprocess/mesh/unit_box.h"
#include "preprocess/model_format/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <span>

namespace splice {
namespace {

using Range = tbb::blocked_range<std::size_t>;

constexpr unsigned kBitsPerAxis = 21;  // three axes in 63 bits

std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

std::uint64_t morton_code(const Vec3f& unit) {
    constexpr float kCells = 1u << kBitsPerAxis;
    std::uint64_t code = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const float cell = std::clamp((unit[axis] + 0.5f) * kCells, 0.0f, kCells - 1);
        code |= spread_bits(static_cast<std::uint64_t>(cell)) << axis;
    }
    return code;
}

struct Key {
    std::uint64_t code;
    std::uint32_t point;
};

UnitBox bounds_of(const std::vector<Vec3f>& points) {
    struct Corners {
        Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    };
    const Corners corners = tbb::parallel_reduce(
        Range(0, points.size()), Corners(),
        [&](const Range& range, Corners c) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                c.low = c.low.cwiseMin(points[i]);
                c.high = c.high.cwiseMax(points[i]);
            }
            return c;
        },
        [](const Corners& a, const Corners& b) {
            return Corners{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
        });
    UnitBox box;
    box.include(corners.low.cast<double>());
    box.include(corners.high.cast<double>());
    return box;
}

// Equal points are side by side, the first of the file first.
std::vector<Key> sorted_keys(const std::vector<Vec3f>& positions) {
    std::vector<Key> keys = large_vector<Key>(positions.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
        keys[i] = {morton_code(positions[i]), static_cast<std::uint32_t>(i)};
    });
    const auto position_order = [](const Vec3f& a, const Vec3f& b) {
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    tbb::parallel_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
        if (a.code != b.code) return a.code < b.code;
        const Vec3f &p = positions[a.point], &q = positions[b.point];
        return p == q ? a.point < b.point : position_order(p, q);
    });
    return keys;
}

// Runs of keys, whose points are near each other, into compact blocks.
void order_keys_by_blocks(std::vector<Key>& keys, const std::vector<Vec3f>& positions) {
    constexpr std::size_t kRun = 4096;
    const std::size_t runs = (keys.size() + kRun - 1) / kRun;
    tbb::parallel_for(Range(0, runs), [&](const Range& range) {
        std::vector<PlacedPoint> points;
        for (std::size_t run = range.begin(); run < range.end(); ++run) {
            const std::span<Key> own = std::span(keys).subspan(run * kRun, std::min(kRun, keys.size() - run * kRun));
            points.clear();
            for (const Key& key : own) {
                const Vec3f& position = positions[key.point];
                points.push_back({{position.x(), position.y(), position.z()}, key.point});
            }
            order_by_blocks(points, kBlockPoints);
            for (std::size_t i = 0; i < own.size(); ++i)
                own[i].point = points[i].index;
        }
    });
}

template <class T>
std::vector<T> permuted(std::vector<T> values, const std::vector<Key>& keys) {
    if (values.empty()) return {};
    std::vector<T> result = large_vector<T>(keys.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) { result[i] = values[keys[i].point]; });
    return result;
}

}  // namespace

UnitCloud make_unit_cloud(PointCloud cloud) {
    if (cloud.offsets.size() >= std::numeric_limits<std::uint32_t>::max())
        throw Error("a cloud of 2^32 - 1 points or more cannot be baked");
    UnitCloud unit;
    const UnitBox box = bounds_of(cloud.offsets);
    const Vec3d centre = box.centre();
    if (box.scale() > 0) unit.source_scale = box.scale();
    unit.source_offset = cloud.origin + centre;
    tbb::parallel_for(std::size_t{0}, cloud.offsets.size(), [&](std::size_t i) {
        cloud.offsets[i] = ((cloud.offsets[i].cast<double>() - centre) / unit.source_scale).cast<float>();
    });

    std::vector<Key> keys = sorted_keys(cloud.offsets);
    const auto same_place = [&](const Key& a, const Key& b) {
        return cloud.offsets[a.point] == cloud.offsets[b.point];
    };
    keys.erase(std::unique(keys.begin(), keys.end(), same_place), keys.end());
    unit.duplicate_points = cloud.offsets.size() - keys.size();

    order_keys_by_blocks(keys, cloud.offsets);
    unit.positions = permuted(std::move(cloud.offsets), keys);
    unit.colours = permuted(std::move(cloud.colours), keys);
    unit.normals = permuted(std::move(cloud.normals), keys);
    tbb::parallel_for(std::size_t{0}, unit.normals.size(), [&](std::size_t i) {
        const double length = unit.normals[i].cast<double>().norm();
        unit.normals[i] = length > 0 ? Vec3f((unit.normals[i].cast<double>() / length).cast<float>()) : Vec3f::Zero();
    });
    return unit;
}

}  // namespace splice
