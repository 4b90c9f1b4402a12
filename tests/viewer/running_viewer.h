// splice-view as another process, the files that its tests give it, and what it writes.
#pragma once

#include "engine/capture/png_file.h"
#include "tests/support/test_files.h"
#include "tests/viewer/virtual_display.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace splice::test {

constexpr std::uint32_t kPanel = 300, kStatus = 26;  // of the interface at scale 1, where the window is not narrow

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

/// A mesh that is neither flat nor symmetric, so that turning it shows.
void write_mesh_file(const std::filesystem::path& path, std::uint32_t segments = 60);
void write_model_file(const std::filesystem::path& mesh, const std::filesystem::path& model);

/// Runs a command line of splice-capture in a shell, as a user who pasted it, and returns its picture, capture.png.
Picture captured_by(const std::filesystem::path& folder, const std::string& line);

/// Works in a folder, which also has its settings; its streams go to files there.
class RunningViewer {
  public:
    RunningViewer(const std::filesystem::path& folder, const std::string& display, std::vector<std::string> arguments);
    ~RunningViewer();
    RunningViewer(const RunningViewer&) = delete;
    RunningViewer& operator=(const RunningViewer&) = delete;

    /// The exit code, once it ended by itself; -1 where it did not.
    int wait(double seconds = 120);
    std::string err() const { return read_text(folder_ / "err.txt"); }
    std::string out() const { return read_text(folder_ / "out.txt"); }

  private:
    std::filesystem::path folder_;
    pid_t process_ = -1;
};

/// What a test in a window needs: a display of its own, and a folder with a mesh, knot.ply.
struct Stage {
    explicit Stage(std::uint32_t segments = 60);
    /// Requires a window that comes to show this file.
    void wait_for(const std::string& file) const;
    /// splice-view on the mesh, or other files, with validation, by this script.
    struct Run {
        int code;
        std::string err;
    };
    Run run_script(const std::string& script, const std::string& size = "1000x600",
                   const std::vector<std::string>& inputs = {"knot.ply"}) const;

    std::unique_ptr<VirtualDisplay> display;  // null where there is no Xvfb: nothing to test
    TemporaryFolder folder;
};

/// Of a picture of the window: what is not interface.
Picture scene_part(const Picture& window);

}  // namespace splice::test
