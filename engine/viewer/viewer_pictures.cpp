// What the window shows: pictures of the scene, drawn anew where something changed, and the interface over them.
#include "engine/capture/camera_path.h"
#include "engine/capture/png_file.h"
#include "engine/viewer/viewer.h"
#include "preprocess/model_format/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

constexpr double kPublishSeconds = 0.25;  // between changes of the panels' numbers, while moving

std::int32_t rounded(double value) {
    return static_cast<std::int32_t>(std::lround(value));
}

std::uint32_t shared(std::uint32_t side, double share) {
    return std::max(1U, static_cast<std::uint32_t>(std::lround(side * share)));
}

}  // namespace

void Viewer::draw_pictures() {
    pictures_whole_ = true;
    refining_ = false;
    if (!state_.scene) return;
    bool any_drawn = false;
    const bool reduced = state_.reduce_while_moving && moving();
    const double share = reduced ? moving_detail_.share() : 1;
    if (!state_.freeze_cut)
        state_.cut_camera.reset();
    else if (!state_.cut_camera)
        state_.cut_camera = state_.camera.camera();
    for (std::size_t i = 0; i < pictures(); ++i) {
        const Viewport viewport = area(i).size;
        CaptureSettings& look = state_.looks[i];
        look.width = viewport.width;
        look.height = viewport.height;
        look.camera = state_.camera.camera();
        look.cut_camera = state_.cut_camera;
        CaptureSettings settings = look;
        settings.width = shared(viewport.width, share);
        settings.height = shared(viewport.height, share);
        if (reduced) {
            settings.antialias = 1;
            settings.tau = std::max(look.tau, moving_detail_.tau());
        }
        settings.wait_for_data = false;
        pictures_whole_ =
            pictures_whole_ && share == 1 && settings.antialias == look.antialias && settings.tau == look.tau;
        Pane& pane = graphics_->panes[i];
        const bool drawn = pane.update(graphics_->device, *graphics_->renderer, state_.scene->loaded.scene,
                                       state_.scene_revision, settings);
        any_drawn = any_drawn || drawn;
        refining_ = refining_ || pane.is_refining(state_.scene->loaded.scene);
        if (!drawn || i != state_.edited_look) continue;
        measured_.stats = pane.stats();
        measured_.history.add(pane.stats().passes);
        measured_.attachment_bytes = graphics_->renderer->attachment_bytes();
        measured_.drawn_width = settings.width;
        measured_.drawn_height = settings.height;
        measured_.drawn_coarser = settings.tau > look.tau;
        if (measurements_are_due()) measured_.graph = graphics_->renderer->last_graph();
    }
    measured_.device_bytes = graphics_->device.memory().statistics().allocated_bytes;
    state_.device_name = graphics_->device.info().name;
    pictures_whole_ = pictures_whole_ && !refining_;
    if (any_drawn) publish_measurements();
}

// Numbers that change with every frame cannot be read, and make the panels different in every frame.
bool Viewer::measurements_are_due() const {
    const Measurements& shown = state_.measured;
    return !moving() || now_ - published_at_ >= kPublishSeconds || shown.drawn_width != measured_.drawn_width ||
           shown.drawn_height != measured_.drawn_height || shown.drawn_coarser != measured_.drawn_coarser;
}

void Viewer::publish_measurements() {
    redraw_ = std::max(redraw_, 1);  // the panels come before the pictures
    if (!measurements_are_due()) return;
    state_.measured = measured_;
    published_at_ = now_;
}

std::vector<ShownPicture> Viewer::shown_pictures() const {
    std::vector<ShownPicture> shown;
    if (!state_.scene) return shown;
    for (std::size_t i = 0; i < pictures(); ++i) {
        const Pane& pane = graphics_->panes[i];
        if (pane.empty()) continue;
        const PictureArea place = area(i);
        PixelRect source{0, 0, static_cast<std::int32_t>(pane.settings().width),
                         static_cast<std::int32_t>(pane.settings().height)};
        PixelRect destination{rounded(place.x), rounded(place.y), static_cast<std::int32_t>(place.size.width),
                              static_cast<std::int32_t>(place.size.height)};
        if (state_.comparison == Comparison::kWipe) {
            const std::int32_t from = rounded(state_.wipe * source.width),
                               to = rounded(state_.wipe * destination.width);
            if (i == 0) {
                source.width = from;
                destination.width = to;
            } else {
                source = {from, 0, source.width - from, source.height};
                destination = {destination.x + to, destination.y, destination.width - to, destination.height};
            }
            if (source.width == 0 || destination.width == 0) continue;
        }
        shown.push_back({&pane.image(), source, destination});
    }
    return shown;
}

// Where the panels are, in the window's pixels.
std::vector<PixelRect> Viewer::panel_parts() const {
    if (!state_.panels) return {};
    const PictureArea picture = area(0);
    const auto width = static_cast<std::int32_t>(window_.pixels().width);
    const auto height = static_cast<std::int32_t>(window_.pixels().height);
    const std::int32_t side = rounded(picture.x), top = static_cast<std::int32_t>(picture.size.height);
    return {{0, 0, side, height}, {side, top, width - side, height - top}};
}

bool Viewer::show_window(WindowPixels* pixels) {
    ShownInterface interface;
    interface.draw = [&](const graph::PassContext& context) { graphics_->interface->draw(context); };
    interface.panels = panel_parts();
    interface.only_panels = content_.within(interface.panels);
    interface.revision = content_.revision();
    const bool shown = graphics_->presenter.present(window_.pixels(), shown_pictures(), interface, pixels);
    state_.present_mode = graphics_->presenter.mode();
    const bool repeat = graphics_->interface->prepare();
    if (repeat) graphics_->presenter.forget_interface();
    if (!shown || repeat) redraw_ = kFramesToSettle;
    return shown && !repeat;
}

void Viewer::advance_turntable() {
    if (!turntable_ || !state_.scene) return;
    CaptureSettings settings = full_settings(state_.edited_look);
    const double angle = 2 * glm::pi<double>() * turntable_->done / turntable_->count;
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0)));
    settings.camera.eye = settings.camera.target + turn * (turntable_->first.eye - turntable_->first.target);
    settings.camera.up = turn * turntable_->first.up;
    try {
        Frame frame = graphics_->renderer->render(state_.scene->loaded.scene, settings);
        write_png(numbered(turntable_->path, turntable_->done, turntable_->count),
                  {frame.width, frame.height, std::move(frame.rgba)});
        if (++turntable_->done < turntable_->count) return;
        report("Wrote " + std::to_string(turntable_->count) + " pictures, the last " +
                   numbered(turntable_->path, turntable_->count - 1, turntable_->count).string(),
               false);
    } catch (const gpu::DeviceLostError&) {
        throw;
    } catch (const Error& error) {
        fail(error.what(), turntable_->line);
    }
    turntable_.reset();
}

}  // namespace splice
