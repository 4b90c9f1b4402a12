// splice-view: the window's loop. Every frame: the script's next step, input, what the loading thread has, panels,
// pictures, the window.
#pragma once

#include "engine/viewer/frame_times.h"
#include "engine/viewer/interface.h"
#include "engine/viewer/interface_content.h"
#include "engine/viewer/pane.h"
#include "engine/viewer/panels.h"
#include "engine/viewer/presenter.h"
#include "engine/viewer/resolution.h"
#include "engine/viewer/script.h"
#include "engine/viewer/shader_watch.h"
#include "engine/viewer/viewer_command_line.h"
#include "engine/viewer/viewer_state.h"
#include "engine/viewer/window.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace splice {

class Viewer {
  public:
    /// Throws SystemError (no display), DeviceError, InputError (of a script).
    explicit Viewer(const ViewerCommandLine& command);
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Until the window is closed. True unless an action of the script failed. Throws DeviceError where the device is
    /// lost a second time, or validation complained.
    bool run();

  private:
    /// All that a lost device takes with it, beside the scene's models.
    struct Graphics {
        Graphics(const Window& window, const gpu::Instance& instance, const std::string& device, gpu::PresentMode mode);
        gpu::Surface surface;
        gpu::Device device;
        std::unique_ptr<Renderer> renderer;  // made anew when shaders change
        Presenter presenter;
        std::unique_ptr<InterfaceDrawing> interface;  // made anew when fonts change
        std::array<Pane, 2> panes;
    };
    static constexpr int kFramesToSettle = 3;  // that the interface needs after an event

    /// A picture a frame, so that the window stays usable.
    struct Turntable {
        std::filesystem::path path;
        Camera first;
        std::uint32_t count = 0, done = 0;
        std::size_t line = 0;  // of the script
    };

    void loop();
    void check_surface();
    void recover();
    double idle_seconds() const;
    bool at_rest() const;
    void note_start(const char* step);

    void play_script();
    void take_input();
    void handle(const InputEvent& event);
    bool handle_key(const InputEvent& event);
    bool handle_divider(const InputEvent& event);
    void pick_at(const glm::dvec2& place);
    std::optional<glm::dvec3> surface_at(std::size_t area, const glm::dvec2& place) const;

    void remember_settings() const;

    void cancel_job();
    void poll_job();
    void show_scene(const SceneRequest& request, PreparedScene prepared);
    void take_looks(const SceneDescription& description);
    void poll_shaders();
    void use_watched_shaders();
    void update_title();
    void draw_panels();
    void draw_pictures();
    bool measurements_are_due() const;
    void publish_measurements();
    std::vector<PixelRect> panel_parts() const;
    bool show_window(WindowPixels* pixels = nullptr);
    void advance_turntable();

    // Commands (viewer_commands.cpp).
    void run_command(const Command& command);
    void set_value(const std::string& name, const std::string& value);
    void open(std::vector<std::filesystem::path> paths, bool again, std::size_t line = 0);
    void go_to(const std::string& bookmark);
    void report(const std::string& text, bool error);
    void fail(const std::string& text, std::size_t line);
    CaptureSettings full_settings(std::size_t look) const;

    // Files (viewer_files.cpp).
    void take_screenshot(const std::filesystem::path& path);
    void take_window_screenshot(const std::filesystem::path& path);
    void save_scene(const std::filesystem::path& path);
    SceneDescription describe(std::size_t look) const;
    bool line_needs_scene(const CaptureSettings& settings) const;
    std::string camera_line();
    void write_statistics(const std::filesystem::path& path);

    Layout layout() const;
    std::size_t pictures() const { return state_.comparison == Comparison::kOff ? 1 : 2; }
    PictureArea area(std::size_t picture) const;
    std::size_t area_at(double window_x) const;
    std::vector<ShownPicture> shown_pictures() const;
    bool moving() const;

    const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
    ViewerCommandLine options_;
    Window window_;
    gpu::Instance instance_;
    Interface interface_;
    std::optional<Graphics> graphics_;
    ViewerState state_;
    std::unique_ptr<SceneJob> job_;
    std::vector<std::unique_ptr<SceneJob>> cancelled_jobs_;  // until they ended
    std::optional<SceneJob::Progress> progress_;
    std::optional<ShaderWatch> shaders_;
    std::vector<ScriptStep> script_;
    std::size_t script_at_ = 0;
    std::size_t script_line_ = 0;  // of the last event or command
    bool script_failed_ = false;
    std::uint64_t frames_to_draw_ = 0;  // of the script's step
    InputQueue input_;
    std::vector<Command> commands_;
    std::optional<Turntable> turntable_;
    MovingDetail moving_detail_;
    std::size_t dragged_area_ = 0;
    bool dragging_divider_ = false;
    double now_ = 0, moved_at_ = -1e9;  // seconds
    double published_at_ = -1e9;        // the measurements
    double surface_checked_at_ = 0;
    int redraw_ = 0;               // frames until the interface is at rest
    bool pictures_whole_ = false;  // drawn, at full resolution, of all surfels
    bool refining_ = false;        // surfels are being read that a picture lacks
    bool quit_ = false;
    bool device_was_lost_ = false, shown_since_recovery_ = false;
    InterfaceContent content_;
    Measurements measured_;                                // up to the last frame
    FrameTimes frame_times_;                               // whole frames
    FrameTimes panel_times_, picture_times_, show_times_;  // their parts
    // Seconds from the start to the end of each step of it, in order.
    std::vector<std::pair<std::string, double>> start_steps_;
};

}  // namespace splice
