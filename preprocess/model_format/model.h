// A whole model as plain data: what build_model returns, what the writer takes, what the reader yields views of.
#pragma once

#include "preprocess/model_format/model_format.h"

#include <filesystem>
#include <span>
#include <vector>

namespace splice {

/// Owning form, filled by the preprocessor.
struct Model {
    format::ModelInfo info{};
    std::vector<format::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<format::Surfel> surfels;
    std::vector<format::Patch> patches;
    std::vector<format::Lod> lods;
    std::vector<format::OctreeNode> octree;
    std::vector<format::MergeNode> merge_tree;
    std::vector<format::Material> materials;
    std::vector<format::Texture> textures;
    std::vector<std::byte> texels;
    std::vector<format::PackedPointNode> point_tree;
    std::vector<format::PackedSurfel> packed_surfels;  // of a point cloud, in place of `surfels`
};

/// Borrowed form: spans into a Model or into a mapped file; what the engine loads from. The owner must outlive it.
struct ModelView {
    const format::ModelInfo* info = nullptr;
    std::span<const format::Vertex> vertices;
    std::span<const std::uint32_t> indices;
    std::span<const format::Surfel> surfels;
    std::span<const format::Patch> patches;
    std::span<const format::Lod> lods;
    std::span<const format::OctreeNode> octree;
    std::span<const format::MergeNode> merge_tree;
    std::span<const format::Material> materials;
    std::span<const format::Texture> textures;
    std::span<const std::byte> texels;
    std::span<const format::PackedPointNode> point_tree;
    std::span<const format::PackedSurfel> packed_surfels;

    bool is_packed() const { return !packed_surfels.empty(); }
    std::uint64_t surfel_count() const { return is_packed() ? packed_surfels.size() : surfels.size(); }
    /// Unpacked where it is packed (packed_surfel.h).
    format::Surfel surfel(std::uint64_t index) const;
};

ModelView view_of(const Model& model);

/// Serialises, byte for byte the same for the same model. Written to a temporary file beside `path`, flushed, renamed;
/// on failure nothing is left behind. Returns the file's size. Throws SystemError.
std::uint64_t write_model(const ModelView& model, const std::filesystem::path& path);

/// The same, compressed (compressed_model.h). Throws UsageError where this build cannot.
std::uint64_t write_compressed_model(const ModelView& model, const std::filesystem::path& path);

/// The same bytes in memory (tests, fuzzing).
std::vector<std::byte> serialise_model(const ModelView& model);

/// Checks magic, version, sizes, alignment, checksum and every index and range in the tables (no size in the file is
/// trusted), then returns views into `bytes`. `name` is for messages. Throws InputError with the byte offset.
ModelView parse_model(std::span<const std::byte> bytes, const std::string& name);

/// A model file mapped (or read) into memory.
class ModelFile {
  public:
    explicit ModelFile(const std::filesystem::path& path);  // throws InputError, SystemError
    ModelFile(const ModelFile&) = delete;
    ModelFile& operator=(const ModelFile&) = delete;
    ModelFile(ModelFile&&) noexcept;
    ModelFile& operator=(ModelFile&&) noexcept;
    ~ModelFile();
    const ModelView& view() const { return view_; }
    /// As they are in the file.
    std::span<const std::byte> bytes() const { return bytes_; }
    /// The whole of it is in memory, expanded, and stays there.
    bool is_compressed() const { return !expanded_.empty(); }
    /// Lets go of the memory that holds a part of the view, until it is read again.
    void release(std::span<const std::byte> part) const;

  private:
    std::span<const std::byte> bytes_;
    std::vector<std::byte> expanded_;
    ModelView view_;
};

}  // namespace splice
