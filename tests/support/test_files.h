// Where tests find and leave files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace splice::test {

/// The collection of real models: $SPLICE_MODELS, else ../shared/models beside the source tree. Nothing when the folder
/// or the named file is absent: then prints what is skipped (Catch2 2.13 has no SKIP()) and the test returns.
///   const auto bunny = model_file("meshes/bunny.smf"); if (!bunny) return;
std::optional<std::filesystem::path> model_file(const std::string& relative);

/// A file of the source tree, e.g. source_file("scenes/checkerboard.json").
std::filesystem::path source_file(const std::string& relative);

/// Programs built with the tests, e.g. program("splice-bake").
std::filesystem::path program(const std::string& name);

/// A fresh folder under the build tree, removed with everything in it at the end of the scope.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// Where failing image tests leave what they saw; survives the run.
std::filesystem::path artefact(const std::string& name);

}  // namespace splice::test
