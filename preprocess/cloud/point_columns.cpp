#include "preprocess/cloud/point_columns.h"

#include "preprocess/large_vector.h"
#include "preprocess/mesh/source_mesh_builder.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace splice {
namespace {

// Records of a unit of work. Units are counted first and then written where the ones before them end, so the order is
// that of the file whatever the number of threads.
constexpr std::size_t kBlock = 1 << 16;

enum class Verdict { kUsable, kNonfinite, kWithheld };

struct BlockCount {
    std::size_t usable = 0, nonfinite = 0, withheld = 0;
};

class Gatherer {
  public:
    explicit Gatherer(const PointColumns& columns) : columns_(columns) {}

    PointCloud gather() {
        cloud_.source_points = columns_.records;
        find_origin();
        const std::size_t blocks = (columns_.records + kBlock - 1) / kBlock;
        std::vector<BlockCount> counts(blocks);
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) { counts[b] = count(b); });
        std::size_t total = 0;
        for (BlockCount& block : counts) {
            cloud_.nonfinite_points += block.nonfinite;
            cloud_.withheld_points += block.withheld;
            total += std::exchange(block.usable, total);
        }
        cloud_.offsets = large_vector<Vec3f>(total);
        if (columns_.normal[0]) cloud_.normals = large_vector<Vec3f>(total);
        if (columns_.colour[0] || columns_.packed_rgb) cloud_.colours = large_vector<std::uint32_t>(total);
        tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) { write(b, counts[b].usable); });
        return std::move(cloud_);
    }

  private:
    static Vec3d vector_at(const ScalarColumn (&columns)[3], std::size_t record) {
        return {columns[0][record], columns[1][record], columns[2][record]};
    }
    Vec3f offset_at(std::size_t record) const {
        return (vector_at(columns_.position, record) - cloud_.origin).cast<float>();
    }
    bool is_withheld(std::size_t record) const {
        return columns_.flags && (static_cast<unsigned>(columns_.flags[record]) & columns_.withheld_if) != 0;
    }
    Verdict judge(std::size_t record) const {
        if (is_withheld(record)) return Verdict::kWithheld;
        return offset_at(record).allFinite() ? Verdict::kUsable : Verdict::kNonfinite;
    }

    void find_origin() {
        for (std::size_t record = 0; record < columns_.records; ++record) {
            const Vec3d position = vector_at(columns_.position, record);
            if (!position.allFinite() || is_withheld(record)) continue;
            cloud_.origin = position;
            return;
        }
    }

    std::size_t end_of(std::size_t block) const { return std::min(columns_.records, (block + 1) * kBlock); }

    BlockCount count(std::size_t block) const {
        BlockCount result;
        for (std::size_t record = block * kBlock; record < end_of(block); ++record) {
            const Verdict verdict = judge(record);
            result.usable += verdict == Verdict::kUsable;
            result.nonfinite += verdict == Verdict::kNonfinite;
            result.withheld += verdict == Verdict::kWithheld;
        }
        return result;
    }

    void write(std::size_t block, std::size_t to) {
        for (std::size_t record = block * kBlock; record < end_of(block); ++record) {
            if (judge(record) != Verdict::kUsable) continue;
            cloud_.offsets[to] = offset_at(record);
            if (!cloud_.normals.empty()) {
                const Vec3f normal = vector_at(columns_.normal, record).cast<float>();
                cloud_.normals[to] = normal.allFinite() ? normal : Vec3f::Zero();
            }
            if (!cloud_.colours.empty()) cloud_.colours[to] = colour_at(record);
            ++to;
        }
    }

    std::uint32_t colour_at(std::size_t record) const {
        if (columns_.packed_rgb) {
            const auto rgb = static_cast<std::uint32_t>(columns_.packed_rgb[record]);
            return (rgb >> 16 & 255u) | (rgb & 0xff00u) | (rgb & 255u) << 16 | 0xff000000u;
        }
        const Vec3d rgb = vector_at(columns_.colour, record);
        return pack_colour(rgb.x(), rgb.y(), rgb.z());
    }

    const PointColumns& columns_;
    PointCloud cloud_;
};

}  // namespace

PointCloud gather_points(const PointColumns& columns) {
    return Gatherer(columns).gather();
}

}  // namespace splice
