// Runs the program splice-bake that lies beside this one, so that what is measured is what a user gets.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace splice::bench {

/// A folder for temporary files, gone with its owner. Throws SystemError.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

struct BakeRun {
    nlohmann::json stats;      // of --stats
    double processor_seconds;  // of all threads, the system's part included
};

/// The model is thrown away. Throws SystemError when the bake fails.
BakeRun run_bake(const std::filesystem::path& input, const std::vector<std::string>& arguments);

}  // namespace splice::bench
