#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/checksum.h"
#include "preprocess/model_format/compressed_model.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/section_layout.h"

#include <algorithm>
#include <cstring>

namespace splice {
namespace {

using namespace format;

// Header and table: everything before the first section.
struct FileStart {
    FileHeader header{};
    std::array<SectionEntry, kSectionCount> table{};
    std::array<std::byte, round_up_to_alignment(sizeof table) - sizeof table> padding{};
};
static_assert(sizeof(FileStart) % kSectionAlignment == 0);

FileStart lay_out(const ModelView& view) {
    FileStart start;
    std::memcpy(start.header.magic, kMagic, sizeof(kMagic));
    start.header.version = kVersion;
    start.header.section_count = kSectionCount;
    start.header.table_offset = sizeof(FileHeader);
    std::uint64_t offset = sizeof(FileStart);
    std::size_t section = 0;
    for_each_section(view, [&]<typename T>(SectionKind kind, const char*, std::span<const T> elements) {
        start.table[section++] = {kind, sizeof(T), offset, elements.size(), 0};
        offset += round_up_to_alignment(elements.size_bytes());
    });
    start.header.file_bytes = offset;
    return start;
}

// Hands the sections to `sink` in file order in pieces that are whole multiples of the alignment, padding included.
template <typename Sink>
void for_each_piece(const ModelView& view, const Sink& sink) {
    for_each_section(view, [&](SectionKind, const char*, const auto& elements) {
        const auto bytes = std::as_bytes(elements);
        const std::size_t whole = bytes.size() / kSectionAlignment * kSectionAlignment;
        if (whole != 0) sink(bytes.first(whole));
        if (whole == bytes.size()) return;
        std::array<std::byte, kSectionAlignment> tail{};
        std::ranges::copy(bytes.subspan(whole), tail.begin());
        sink(std::span<const std::byte>(tail));
    });
}

// The checksum needs all bytes before the header can be written, so the model is walked twice rather than copied.
template <typename Sink>
std::uint64_t write_all(const ModelView& view, const Sink& sink) {
    FileStart start = lay_out(view);
    const auto start_bytes = std::as_bytes(std::span(&start, 1));
    Checksum checksum;
    checksum.add(start_bytes);
    for_each_piece(view, [&](std::span<const std::byte> piece) { checksum.add(piece); });
    start.header.checksum = checksum.value();
    sink(start_bytes);
    for_each_piece(view, sink);
    return start.header.file_bytes;
}

}  // namespace

ModelView view_of(const Model& model) {
    return {&model.info,  model.vertices,   model.indices,       model.surfels,   model.patches,
            model.lods,   model.octree,     model.merge_tree,    model.materials, model.textures,
            model.texels, model.point_tree, model.packed_surfels};
}

Surfel ModelView::surfel(std::uint64_t index) const {
    if (!is_packed()) return surfels[index];
    return unpack_surfel(packed_surfels[index], static_cast<std::uint16_t>(index / kPackedBlock));
}

std::uint64_t write_model(const ModelView& view, const std::filesystem::path& path) {
    AtomicFile file(path);
    const std::uint64_t size = write_all(view, [&](std::span<const std::byte> piece) { file.write(piece); });
    file.commit();
    return size;
}

std::uint64_t write_compressed_model(const ModelView& view, const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = compress_model(serialise_model(view));
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
    return bytes.size();
}

std::vector<std::byte> serialise_model(const ModelView& view) {
    std::vector<std::byte> bytes;
    bytes.reserve(lay_out(view).header.file_bytes);
    write_all(view, [&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
    return bytes;
}

}  // namespace splice
