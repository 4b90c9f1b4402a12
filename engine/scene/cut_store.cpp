#include "engine/scene/cut_store.h"

#include "engine/scene/gpu_model.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace splice {

namespace {

// Shorter runs are copied: a draw costs as much as some hundred surfels.
constexpr std::uint32_t kInPlace = 2048;

// Draws of triangles that are not worth copying what they draw.
constexpr std::size_t kFewDraws = 16;

// A run and where its records go.
struct Piece {
    const GpuModel* model;
    std::uint64_t first, count;
    std::uint64_t place;
    std::uint32_t level;
    bool inner;
};

class Gathering {
  public:
    explicit Gathering(bool levels) : levels_(levels) {}

    std::uint64_t count() const { return count_; }
    void copy_to(std::span<format::Surfel> records) const {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces_.size(), 256), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Piece& piece = pieces_[i];
                const auto copied = records.subspan(piece.place, piece.count);
                if (piece.inner) {
                    const auto ellipses = piece.model->ellipses().subspan(piece.first, piece.count);
                    std::copy(ellipses.begin(), ellipses.end(), copied.begin());
                } else {
                    piece.model->copy_surfels(piece.first, copied);
                }
                if (levels_ && piece.inner)
                    for (format::Surfel& record : copied)
                        record.patch = static_cast<std::uint16_t>(piece.level);
            }
        });
    }

    // The ranges of an instance: in place in `instance` itself, the others in what is returned.
    InstanceDraws add(InstanceDraws& instance) {
        InstanceDraws gathered;
        gathered.model = instance.model;
        gathered.model_to_view = instance.model_to_view;
        gathered.scale = instance.scale;
        gathered.two_sided = instance.two_sided;
        gathered.first_patch = instance.first_patch;
        add_runs(instance, true, instance.sprites, gathered.sprites);
        add_runs(instance, false, instance.quads, gathered.quads);
        return gathered;
    }

  private:
    void add_runs(const InstanceDraws& instance, bool points, std::vector<DrawRange>& in_place,
                  std::vector<DrawRange>& gathered) {
        DrawRange range{.first = count_};
        for (const CutRun& run : instance.cut.runs) {
            if (run.fits_point != points) continue;
            if (!run.inner && run.count >= kInPlace && instance.model->pager() == nullptr) {
                in_place.push_back({.first = run.first, .count = run.count});
                continue;
            }
            pieces_.push_back({instance.model, run.first, run.count, count_, run.level, run.inner});
            count_ += run.count;
            range.count += run.count;
        }
        if (range.count != 0) gathered.push_back(range);
    }

    bool levels_;
    std::uint64_t count_ = 0;
    std::vector<Piece> pieces_;
};

}  // namespace

void CutStore::gather(DrawList& draws, bool levels) {
    Gathering gathering(levels);
    std::vector<InstanceDraws> added;
    for (InstanceDraws& instance : draws.instances)
        if (!instance.cut.runs.empty()) added.push_back(gathering.add(instance));
    if (gathering.count() == 0) return;
    if (!store_ || store_->capacity() < gathering.count()) {
        store_.reset();
        store_.emplace(device_, gathering.count() + gathering.count() / 2, SurfelRecords::kPlain,
                       gpu::MemoryUse::upload, "cut");
    }
    gathering.copy_to(store_->mapped());
    for (InstanceDraws& instance : added) {
        instance.surfels = &*store_;
        draws.instances.push_back(std::move(instance));
    }
}

void CutStore::gather_triangles(DrawList& draws) {
    struct Copy {
        const std::byte* from;
        std::uint64_t to, bytes;
    };
    constexpr std::uint64_t kIndex = sizeof(std::uint32_t);
    std::vector<Copy> copies;
    std::uint64_t bytes = 0;
    for (InstanceDraws& instance : draws.instances) {
        const std::span<const std::byte> indices = instance.model->indices().mapped();
        if (instance.triangles.size() < kFewDraws || indices.empty()) continue;
        std::stable_sort(instance.triangles.begin(), instance.triangles.end(),
                         [](const DrawRange& a, const DrawRange& b) { return a.material < b.material; });
        std::vector<DrawRange> gathered;
        for (const DrawRange& range : instance.triangles) {
            constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
            if (gathered.empty() || gathered.back().material != range.material ||
                gathered.back().count > kMost - range.count)
                gathered.push_back({.first = bytes / kIndex, .material = range.material});
            gathered.back().count += range.count;
            copies.push_back({indices.data() + range.first * kIndex, bytes, range.count * kIndex});
            bytes += range.count * kIndex;
        }
        instance.triangles = std::move(gathered);
        instance.indices = &indices_;
    }
    if (bytes == 0) return;
    if (!indices_ || indices_.size() < bytes) {
        indices_ = gpu::Buffer();
        indices_ = gpu::Buffer(device_, {.size = bytes + bytes / 2,
                                         .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                                         .memory = gpu::MemoryUse::upload,
                                         .name = "cut indices"});
    }
    std::byte* const to = indices_.mapped().data();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, copies.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            std::memcpy(to + copies[i].to, copies[i].from, copies[i].bytes);
    });
}

}  // namespace splice
