// Clip lines of surfels: Zwicker, Raesaenen, Botsch, Dachsbacher and Pauly 2004, "Perspective accurate splatting",
// found here from the mesh instead of drawn by hand.
#include "preprocess/surfel/disk_clip.h"

#include "preprocess/model_format/surfel_clip.h"

#include <algorithm>
#include <optional>

namespace splice {
namespace {

constexpr float kSlack = 0.004f;   // radii: rounding of the stored position, radius and normal
constexpr float kWorthIt = 0.96f;  // radii: lines farther out are left away

}  // namespace

std::vector<std::uint16_t> fit_disk_clips(const IndexedMesh& mesh, const SmoothNeighbours& neighbours,
                                          const CoverCells& cells, const std::vector<CoverSite>& sites,
                                          const std::vector<std::uint32_t>& owner) {
    std::vector<std::uint32_t> support_of(sites.size(), kNoSite);
    std::vector<Support> supports;
    std::vector<DiskFrame> frames;
    Sheet sheet(mesh, neighbours);
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (!(sites[s].radius > 0)) continue;
        const DiskFrame frame(sites[s].position, sites[s].normal, sites[s].radius);
        const std::optional<Support> support = sheet.end_of(sites[s].triangle, frame);
        if (!support) continue;
        support_of[s] = static_cast<std::uint32_t>(supports.size());
        supports.push_back(*support);
        frames.push_back(frame);
    }
    for (const CellChunk& chunk : cells.chunks) {
        CoverCells::for_each_cell(chunk, [&](std::uint32_t cell, const std::array<Vec3f, 4>& corners) {
            const std::uint32_t at = owner[cell] == kNoSite ? kNoSite : support_of[owner[cell]];
            if (at == kNoSite) return;
            for (const Vec3f& corner : corners)
                reach_to(supports[at], frames[at](corner));
        });
    }
    std::vector<std::uint16_t> clips(sites.size(), kNoClip);
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (support_of[s] == kNoSite) continue;
        const Support& reached = supports[support_of[s]];
        const auto least = std::min_element(reached.begin(), reached.end());
        if (*least + kSlack < kWorthIt)
            clips[s] = encode_clip(static_cast<int>(least - reached.begin()), *least + kSlack);
    }
    return clips;
}

}  // namespace splice
