#include "engine/viewer/viewer.h"

#include "engine/capture/bake_of_scene.h"
#include "engine/capture/look_settings.h"
#include "engine/scene/gpu_model.h"
#include "engine/viewer/settings_file.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace splice {

namespace {

constexpr double kRestSeconds = 0.2;     // without a move, until the picture is drawn whole
constexpr double kIdleSeconds = 0.5;     // between looks at what no event announces
constexpr double kLongestSeconds = 0.1;  // of flight a frame, after a pause

std::int32_t rounded(double value) {
    return static_cast<std::int32_t>(std::lround(value));
}

}  // namespace

Viewer::Graphics::Graphics(const Window& window, const gpu::Instance& instance, const std::string& name,
                           gpu::PresentMode mode)
    : surface(window.create_surface(instance)),
      device(instance, {.choice = gpu::parse_device_choice(name), .surface = surface.handle()}),
      renderer(std::make_unique<Renderer>(device)),
      presenter(device, surface.handle(), mode),
      interface(std::make_unique<InterfaceDrawing>(device)) {}

Layout Viewer::layout() const {
    const VkExtent2D size = window_.size();
    return lay_out(static_cast<float>(size.width), static_cast<float>(size.height),
                   static_cast<float>(window_.content_scale()), state_.panels);
}

PictureArea Viewer::area(std::size_t picture) const {
    const VkExtent2D pixels = window_.pixels(), size = window_.size();
    const Layout panels = layout();
    const double scale = size.width == 0 ? 1 : static_cast<double>(pixels.width) / size.width;
    PictureArea area;
    area.scale = scale;
    area.x = rounded(static_cast<double>(panels.panel_width) * scale);
    const double width = std::max(pixels.width - area.x, 1.0);
    const double height = pixels.height - std::round(static_cast<double>(panels.status_height) * scale);
    area.size = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(std::max(height, 1.0))};
    if (state_.comparison != Comparison::kSideBySide) return area;
    const double half = std::floor(width / 2);
    area.size.width = std::max(1U, static_cast<std::uint32_t>(picture == 0 ? half : width - half));
    if (picture == 1) area.x += half;
    return area;
}

std::size_t Viewer::area_at(double window_x) const {
    if (state_.comparison != Comparison::kSideBySide) return 0;
    const PictureArea right = area(1);
    return window_x * right.scale >= right.x ? 1 : 0;
}

bool Viewer::moving() const {
    return now_ - moved_at_ < kRestSeconds;
}

bool Viewer::at_rest() const {
    return !job_ && !turntable_ && !moving() && input_.empty() && commands_.empty() &&
           (pictures_whole_ || !state_.scene);
}

double Viewer::idle_seconds() const {
    const bool scripted = script_at_ < script_.size();
    if (scripted || redraw_ > 0 || moving() || turntable_ || !input_.empty()) return 0;
    return job_ || refining_ ? 1.0 / 30 : kIdleSeconds;
}

bool Viewer::run() {
    while (!quit_ && !window_.wants_to_close()) {
        try {
            loop();
        } catch (const gpu::DeviceLostError& error) {
            if (std::exchange(device_was_lost_, true))
                throw DeviceError(std::string("the device was lost twice: ") + error.what());
            recover();
            report(std::string("The device was lost and opened again (") + error.what() + ")", true);
        } catch (const gpu::SurfaceLostError& error) {
            if (gpu::is_lost(graphics_->device, window_.create_surface(instance_).handle()))
                throw SystemError("the window is gone: another program destroyed it");
            // Windows may lose theirs any number of times, but one that nothing was shown on is not worth another.
            if (!shown_since_recovery_)
                throw DeviceError(std::string("the window's surface was lost before anything was shown on it: ") +
                                  error.what());
            recover();
            report(std::string("The window's surface was lost and made anew (") + error.what() + ")", true);
        }
    }
    remember_settings();
    cancel_job();
    // What is being read may take long to notice that nobody wants it.
    window_.hide();
    const std::vector<gpu::ValidationMessage> messages = instance_.messages();
    if (!messages.empty())
        throw DeviceError("the validation layers report " + std::to_string(messages.size()) +
                          " problem(s), the first: " + messages.front().id + ": " + messages.front().text);
    return !script_failed_;
}

void Viewer::remember_settings() const {
    if (options_.script) return;
    const VkExtent2D size = window_.unscaled_size();
    ViewerSettings settings = settings_of(state_, size.width, size.height);
    if (state_.scene && state_.scene->prepared.from_scene_file) {
        // The scene's, not this person's.
        const ViewerSettings before = read_settings();
        settings.backend = before.backend;
        settings.prefilter = before.prefilter;
    }
    save_settings(settings);
}

// What the scene is made of stays in memory, so that another device can take it over.
void Viewer::recover() {
    shown_since_recovery_ = false;
    const std::string device = options_.renderer.device;
    Scene kept;
    if (state_.scene) {
        kept = std::move(state_.scene->loaded.scene);
        state_.scene->loaded.scene = Scene();
        kept.instances.clear();
    }
    graphics_.reset();
    graphics_.emplace(window_, instance_, device, state_.present_mode);
    if (shaders_ && shaders_->error().empty()) use_watched_shaders();
    if (state_.scene) {
        kept.instances = upload_scene(state_.scene->prepared, *graphics_->renderer, options_.memory).scene.instances;
        state_.scene->loaded.scene = std::move(kept);
        ++state_.scene_revision;
    }
}

void Viewer::loop() {
    while (!quit_ && !window_.wants_to_close()) {
        const double idle_s = idle_seconds(), asked = Window::now();
        window_.wait(idle_s);
        const double before = now_;
        now_ = Window::now();
        if (!window_.events().empty() || window_.take_damage()) redraw_ = kFramesToSettle;
        play_script();
        std::move(window_.events().begin(), window_.events().end(), std::back_inserter(input_));
        window_.events().clear();
        check_surface();
        take_input();
        if (state_.navigation.advance(std::min(now_ - before, kLongestSeconds), state_.camera)) moved_at_ = now_;
        poll_job();
        poll_shaders();
        const VkExtent2D pixels = window_.pixels();
        if (pixels.width == 0 || pixels.height == 0) {
            window_.wait(kIdleSeconds / 10);  // nothing can be shown; not to spin
            continue;
        }
        const bool idle = redraw_ == 0 && !moving() && !job_ && frames_to_draw_ == 0 && pictures_whole_ && !turntable_;
        if (idle && commands_.empty()) continue;
        redraw_ = std::max(redraw_ - 1, 0);
        if (interface_.set_scale(window_.content_scale())) {
            graphics_->interface.reset();
            graphics_->interface = std::make_unique<InterfaceDrawing>(graphics_->device);
        }
        const double began = Window::now();
        draw_panels();
        advance_turntable();
        const double panels_done = Window::now();
        draw_pictures();
        const double pictures_done = Window::now();
        shown_since_recovery_ = show_window() || shown_since_recovery_;
        update_title();
        const double ended = Window::now(), frame = ended - (idle_s > 0 ? now_ : asked);
        frame_times_.add(1000 * frame);
        panel_times_.add(1000 * (panels_done - began));
        picture_times_.add(1000 * (pictures_done - panels_done));
        show_times_.add(1000 * (ended - pictures_done));
        if (frame > 0) {
            // A running mean over some ten frames.
            const double rate = 1 / std::max(frame, 1e-4);
            measured_.frames_per_second += (rate - measured_.frames_per_second) * 0.1;
        }
        if (state_.reduce_while_moving && moving())
            moving_detail_.took(frame * 1000, state_.moving_budget_ms, state_.moving_most_tau);
        if (state_.first_picture_s == 0) {
            note_start(state_.scene ? "first picture" : "first frame");
            if (state_.scene) state_.first_picture_s = start_steps_.back().second;
        }
    }
}

// Windows that another program destroyed are not announced, and nothing is shown while nothing changes.
void Viewer::check_surface() {
    if (now_ - surface_checked_at_ < kIdleSeconds) return;
    surface_checked_at_ = now_;
    graphics_->presenter.check_surface();
}

void Viewer::note_start(const char* step) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - started_;
    if (start_steps_.empty() || start_steps_.back().first != step) start_steps_.emplace_back(step, passed.count());
}

void Viewer::cancel_job() {
    if (!job_) return;
    job_->cancel();
    cancelled_jobs_.push_back(std::move(job_));
}

void Viewer::poll_job() {
    std::erase_if(cancelled_jobs_, [](const auto& job) { return job->ended(); });
    if (!job_) {
        progress_.reset();
        return;
    }
    progress_ = job_->progress();
    std::optional<SceneJob::Outcome> outcome = job_->take_outcome();
    if (!outcome) return;
    job_.reset();
    progress_.reset();
    redraw_ = kFramesToSettle;
    if (!outcome->scene) {
        script_failed_ = options_.script.has_value();
        fail(outcome->error, outcome->request.line);
        return;
    }
    try {
        show_scene(outcome->request, std::move(*outcome->scene));
    } catch (const gpu::DeviceLostError&) {
        throw;
    } catch (const Error& error) {
        script_failed_ = options_.script.has_value();
        fail(error.what(), outcome->request.line);
    }
}

void Viewer::show_scene(const SceneRequest& request, PreparedScene prepared) {
    auto scene = std::make_unique<OpenScene>();
    scene->paths = request.paths;
    scene->baked_anew = request.options.bake.has_value();
    scene->name = request.paths.front().filename().string();
    if (request.paths.size() > 1) scene->name += " and " + std::to_string(request.paths.size() - 1) + " more";
    if (state_.first_picture_s == 0) note_start("scene read");
    scene->loaded = upload_scene(prepared, *graphics_->renderer, options_.memory);
    if (state_.first_picture_s == 0) note_start("scene uploaded");
    scene->prepared = std::move(prepared);
    std::map<const HostModel*, bool> counted;
    for (std::size_t i = 0; i < scene->prepared.models.size(); ++i) {
        const HostModel& model = *scene->prepared.models[i];
        const ModelView& view = model.view();
        scene->pickable.push_back({&view, scene->loaded.scene.instances[i].transform});
        scene->bakeable = scene->bakeable || model.baked();
        scene->patches += view.patches.size();
        scene->triangles += view.info->drawn_triangles;
        scene->surfels += view.surfel_count();
        scene->source_triangles += view.info->source_triangles;
        if (std::exchange(counted[&model], true)) continue;
        scene->bytes += view.vertices.size_bytes() + view.indices.size_bytes() + view.surfels.size_bytes() +
                        view.packed_surfels.size_bytes() + view.patches.size_bytes() + view.texels.size_bytes();
    }
    for (const std::string& warning : scene->loaded.warnings)
        report(warning, false);

    const SceneDescription& description = scene->loaded.description;
    const Box bounds = scene->loaded.scene.bounds();
    state_.camera.set_bounds(bounds);
    state_.picked.reset();
    if (!request.keep_camera) {
        const Viewport viewport = area(0).size;
        state_.camera.set_camera(description.camera
                                     ? *description.camera
                                     : frame_camera(bounds, description.framing, viewport.width, viewport.height));
        state_.bake = BakeOptions{};
        for (std::size_t i = scene->prepared.models.size(); i-- > 0;)
            if (scene->prepared.models[i]->baked()) state_.bake = bake_of(description.models[i]);
        // Files without a say leave the window's settings.
        if (scene->prepared.from_scene_file) take_looks(description);
        // As splice-capture's options go before a scene's; scenes that are opened later are shown as they say.
        if (options_.merge_px && !state_.scene)
            for (CaptureSettings& look : state_.looks)
                look.merge_px = *options_.merge_px;
        if (!description.levels_from) state_.freeze_cut = false;
    } else if (state_.scene) {
        // The same scene, baked anew: what was set in the window stays.
        scene->loaded.scene.lighting = state_.scene->loaded.scene.lighting;
        scene->loaded.scene.background = state_.scene->loaded.scene.background;
        scene->loaded.description.bookmarks = state_.scene->loaded.description.bookmarks;
    }
    state_.scene = std::move(scene);
    ++state_.scene_revision;
}

void Viewer::take_looks(const SceneDescription& description) {
    state_.comparison = description.comparison.kind;
    state_.wipe = description.comparison.wipe;
    state_.edited_look = 0;
    apply_look(description.look, state_.looks[0]);
    apply_look(state_.comparison == Comparison::kOff ? description.look : description.comparison.right,
               state_.looks[1]);
    if (state_.comparison == Comparison::kOff) state_.looks[1].shown = Shown::kTriangles;
    state_.freeze_cut = description.levels_from.has_value();
    state_.cut_camera = description.levels_from;
}

void Viewer::poll_shaders() {
    if (!shaders_ || !shaders_->poll(now_)) return;
    redraw_ = kFramesToSettle;
    if (!shaders_->error().empty()) {
        report(shaders_->error(), true);
        return;
    }
    use_watched_shaders();
    ++state_.scene_revision;
    state_.messages.clear();
    report("Shaders compiled anew", false);
}

void Viewer::use_watched_shaders() {
    graphics_->device.wait_idle();
    graphics_->device.replace_shaders(shaders_->shaders());
    graphics_->renderer = std::make_unique<Renderer>(graphics_->device);
}

void Viewer::update_title() {
    std::string title = "splice-view";
    if (state_.scene) title = state_.scene->name + " - " + title;
    if (job_) title = "loading " + job_->request().paths.front().filename().string() + " - splice-view";
    window_.set_title(title);
}

void Viewer::draw_panels() {
    interface_.begin_frame();
    PanelContext context{state_, commands_, progress_, shaders_ ? shaders_->status() : ""};
    const Layout panels = layout();
    if (state_.panels) {
        draw_side_panel(context, panels);
        draw_status_bar(context, panels);
    }
    draw_graph_window(context, panels);
    draw_overlays(context, panels);
    interface_.end_frame();
    content_.take();
    // Commands may add commands. Those of panels were asked for by the script's hand, if it has one.
    while (!commands_.empty()) {
        Command command = commands_.front();
        commands_.erase(commands_.begin());
        if (command.line == 0 && script_at_ < script_.size()) command.line = script_line_;
        try {
            run_command(command);
        } catch (const gpu::DeviceLostError&) {
            throw;
        } catch (const gpu::SurfaceLostError&) {
            throw;
        } catch (const Error& error) {
            fail(error.what(), command.line);
        }
        redraw_ = kFramesToSettle;
    }
}

}  // namespace splice
