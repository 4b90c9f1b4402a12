// Which section holds which member of a model, in file order: the one place that writer, reader and splice-info share.
#pragma once

#include "preprocess/model_format/model.h"

#include <array>
#include <span>
#include <type_traits>

namespace splice::format {

inline constexpr std::size_t kSectionCount = 13;

constexpr std::uint64_t round_up_to_alignment(std::uint64_t bytes) {
    return (bytes + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
}

/// Calls visit(kind, name, span member of `view`) for each section in file order, which is that of SectionKind.
/// ModelInfo is a pointer in the view and visited as a span of one.
template <typename View, typename Visitor>
void for_each_section(View& view, const Visitor& visit) {
    std::span<const ModelInfo> info(view.info, view.info ? 1 : 0);
    visit(SectionKind::kModelInfo, "model info", info);
    if constexpr (!std::is_const_v<View>) view.info = info.empty() ? nullptr : info.data();
    visit(SectionKind::kVertices, "vertices", view.vertices);
    visit(SectionKind::kIndices, "indices", view.indices);
    visit(SectionKind::kSurfels, "surfels", view.surfels);
    visit(SectionKind::kPatches, "patches", view.patches);
    visit(SectionKind::kLods, "levels of detail", view.lods);
    visit(SectionKind::kOctree, "octree", view.octree);
    visit(SectionKind::kMergeTree, "merge tree", view.merge_tree);
    visit(SectionKind::kMaterials, "materials", view.materials);
    visit(SectionKind::kTextures, "textures", view.textures);
    visit(SectionKind::kTexels, "texels", view.texels);
    visit(SectionKind::kPointTree, "point tree", view.point_tree);
    visit(SectionKind::kPackedSurfels, "packed surfels", view.packed_surfels);
}

}  // namespace splice::format
