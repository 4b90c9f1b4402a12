// Reads and bakes a scene on another thread, so that the window stays usable.
#pragma once

#include "engine/capture/prepare_scene.h"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace splice {

struct SceneRequest {
    std::vector<std::filesystem::path> paths;
    PrepareOptions options;
    bool keep_camera = false;  // the same scene, baked in another way
    std::size_t line = 0;      // of the script that asked for it; 0: none
};

class SceneJob {
  public:
    struct Progress {
        std::string stage;    // empty before the first
        double fraction = 0;  // of the stage
    };
    struct Outcome {
        SceneRequest request;
        std::optional<PreparedScene> scene;
        std::string error;  // where there is no scene; empty if it was cancelled
    };

    explicit SceneJob(SceneRequest request);
    SceneJob(const SceneJob&) = delete;
    SceneJob& operator=(const SceneJob&) = delete;
    /// Cancels, and waits until the work ended.
    ~SceneJob();

    /// Work ends when the stage that runs reports progress next, or ends. Does not wait for that.
    void cancel() { cancelled_ = true; }
    /// Whether the thread is done, so that the destructor does not wait.
    bool ended() const { return ended_; }

    const SceneRequest& request() const { return request_; }
    Progress progress() const;
    /// Once, after the work ended; before, and later, nothing.
    std::optional<Outcome> take_outcome();

  private:
    void run();

    const SceneRequest request_;
    std::atomic<bool> cancelled_ = false, ended_ = false;
    mutable std::mutex mutex_;
    Progress progress_;               // guarded
    std::optional<Outcome> outcome_;  // guarded
    std::thread thread_;              // last: starts when all else is there
};

}  // namespace splice
