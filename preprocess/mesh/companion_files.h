// Files that a mesh refers to by name: material libraries and textures. A mesh from a stranger must not make the
// program open what lies elsewhere, so only regular files inside the mesh's own folder are read.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

class CompanionFiles {
  public:
    /// Finds nothing; for meshes that have no folder.
    CompanionFiles() = default;
    explicit CompanionFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// True if `name` is a readable file inside the folder; says nothing otherwise.
    bool contains(const std::string& name) const;

    /// The file's bytes. When there is no such file or it lies outside the folder: nothing, and the reason in
    /// `problem`.
    std::optional<std::string> read(const std::string& name, std::string& problem) const;

    /// Those that read() found, as often as they were read: a bake must not overwrite them.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }

    /// An image in PNG, JPEG, BMP, TGA or PPM; nothing and the reason when it is absent or unreadable.
    std::optional<Image> read_image(const std::string& name, std::string& problem) const;

  private:
    std::optional<std::filesystem::path> find(const std::string& name, std::string& problem) const;
    std::optional<std::filesystem::path> folder_;
    mutable std::vector<std::filesystem::path> files_read_;  // a record, no part of what is found
};

/// Decodes PNG, JPEG, BMP, TGA or PPM. On failure: nothing, and the reason in `problem`.
std::optional<Image> decode_image(std::string_view bytes, std::string& problem);

}  // namespace splice
