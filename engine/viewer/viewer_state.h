// What panels, commands and the frame loop share: plain data.
#pragma once

#include "engine/capture/capture.h"
#include "engine/capture/load_scene.h"
#include "engine/scene/scene_look.h"
#include "engine/viewer/camera_controller.h"
#include "engine/viewer/navigation.h"
#include "engine/viewer/pass_history.h"
#include "engine/viewer/picking.h"
#include "engine/viewer/resolution.h"
#include "engine/viewer/scene_job.h"
#include "engine/vulkan/swapchain.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

/// A scene in memory and on the device.
struct OpenScene {
    std::vector<std::filesystem::path> paths;
    std::string name;  // of the file, or of the first and how many more
    PreparedScene prepared;
    LoadedScene loaded;
    std::vector<PickableModel> pickable;  // one an instance
    bool bakeable = false;                // something in it is a mesh or a shape
    bool baked_anew = false;              // with options of the window, in place of the files'
    std::uint64_t patches = 0, triangles = 0, surfels = 0, source_triangles = 0, bytes = 0;  // of all instances
};

struct Message {
    std::string text;
    bool error = false;
};

/// What the last frames took and held, of the look that is edited.
struct Measurements {
    PassHistory history;
    FrameStats stats;
    graph::FramePicture graph;
    std::uint32_t drawn_width = 0, drawn_height = 0;  // of the picture as drawn; smaller than shown while moving
    bool drawn_coarser = false;                       // with a larger tau than the look's, while moving
    double frames_per_second = 0;
    std::uint64_t device_bytes = 0, attachment_bytes = 0;
};

struct ViewerState {
    // What is shown: one look, or two to compare. Camera and size are the window's and filled in for each frame.
    std::array<CaptureSettings, 2> looks;
    std::size_t edited_look = 0;
    Comparison comparison = Comparison::kOff;
    double wipe = 0.5;  // share of the picture that is left of the line
    bool reduce_while_moving = true;
    double moving_budget_ms = MovingDetail::kTargetMs;  // of a frame while the camera moves
    double moving_most_tau =
        MovingDetail::kCoarsest;  // pixels of the picture as drawn, while the camera moves; 0: held
    bool freeze_cut = false;      // levels of detail stay those of `cut_camera`
    std::optional<Camera> cut_camera;

    // The camera.
    CameraController camera;
    Navigation navigation;

    // The scene.
    std::unique_ptr<OpenScene> scene;
    std::uint64_t scene_revision = 0;  // changes with models, lights and background
    BakeOptions bake;                  // for what is baked from now on
    std::optional<Hit> picked;

    // The interface.
    bool panels = true, graph_window = false;
    std::vector<Message> messages;
    int lit_pass = -1;  // of the last frame's graph, under the cursor
    gpu::PresentMode present_mode = gpu::PresentMode::fifo;

    Measurements measured;       // as the panels say them
    double first_picture_s = 0;  // from the start of the program to the window with the first picture
    std::string device_name;
};

}  // namespace splice
