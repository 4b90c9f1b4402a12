#include "preprocess/model_format/checksum.h"
#include "preprocess/model_format/compressed_model.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/point_node.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

using namespace splice;

namespace {

/// Size and checksum as a forger would set them, else damage would never get past the header.
void forge_header(std::vector<std::byte>& bytes) {
    format::FileHeader header{};
    if (bytes.size() < sizeof header) return;
    std::memcpy(&header, bytes.data(), sizeof header);
    header.file_bytes = bytes.size();
    header.checksum = 0;
    std::memcpy(bytes.data(), &header, sizeof header);
    Checksum checksum;
    checksum.add(bytes);
    header.checksum = checksum.value();
    std::memcpy(bytes.data(), &header, sizeof header);
}

template <class Element>
std::uint64_t sum_bytes(std::span<const Element> elements) {
    std::uint64_t sum = 0;
    for (const std::byte b : std::as_bytes(elements))
        sum += static_cast<std::uint64_t>(b);
    return sum;
}

/// Reads all that the views promise, and follows every index the way the engine does.
std::uint64_t walk(const ModelView& view) {
    std::uint64_t sum = sum_bytes(view.vertices) + sum_bytes(view.surfels) + sum_bytes(view.octree) +
                        sum_bytes(view.merge_tree) + sum_bytes(view.texels);
    for (const std::uint32_t index : view.indices)
        sum += view.vertices[index].colour;
    for (const format::Surfel& surfel : view.surfels)
        sum += view.patches[surfel.patch].surfel_count;
    for (const format::Lod& lod : view.lods)
        sum += sum_bytes(view.indices.subspan(lod.first_index, lod.index_count));
    for (const format::Texture& t : view.textures)
        sum += sum_bytes(view.texels.subspan(t.first_byte, t.byte_count));
    for (const format::OctreeNode& node : view.octree) {
        sum += sum_bytes(view.patches.subspan(node.first_patch, node.patch_count));
        sum += sum_bytes(view.octree.subspan(node.first_child, node.child_count));
    }
    const std::vector<format::PointNode> tree = unpack_point_tree(view.point_tree);
    for (const format::PointNode& node : tree) {
        for (std::uint64_t i = node.first_surfel; i < node.first_surfel + node.surfel_count; ++i)
            sum += view.surfel(i).radius;
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            sum += tree.at(node.first_child + child).surfel_count;
    }
    return sum;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::byte> bytes(size);
    if (size > 0) std::memcpy(bytes.data(), data, size);
    for (const bool forged : {false, true}) {
        if (forged) forge_header(bytes);
        try {
            const std::vector<std::byte> expanded =
                is_compressed_model(bytes) ? expand_model(bytes, "input") : std::vector<std::byte>();
            const ModelView view = parse_model(expanded.empty() ? bytes : expanded, "input");
            // Keeps the reads from being optimised away.
            volatile std::uint64_t sum = walk(view);
            static_cast<void>(sum);
        } catch (const Error&) {
            continue;
        }
    }
    return 0;
}
