// What reaches the viewer: the script's steps, and the events of hands.
#include "engine/viewer/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace splice {

namespace {

constexpr double kDividerPixels = 6;  // beside the wipe's line that still grab it

}  // namespace

void Viewer::play_script() {
    if (script_at_ >= script_.size()) return;
    redraw_ = kFramesToSettle;
    const ScriptStep& step = script_[script_at_];
    if (const auto* frames = std::get_if<DrawFrames>(&step)) {
        if (frames_to_draw_ == 0) frames_to_draw_ = frames->count;
        if (--frames_to_draw_ > 0) return;
    } else if (std::holds_alternative<WaitForRest>(step)) {
        if (!at_rest()) return;
    } else if (const auto* event = std::get_if<InputEvent>(&step)) {
        if (!input_.empty()) return;
        script_line_ = event->line;
        window_.events().push_back(*event);
    } else {
        if (!input_.empty()) return;
        const auto& command = std::get<Command>(step);
        script_line_ = command.line;
        commands_.push_back(command);
    }
    ++script_at_;
}

// Panels learn where the cursor is from one frame to the next, and see a button only where it is as a frame begins: so
// a frame takes moves, or one change of a button or key.
void Viewer::take_input() {
    bool moved = false, changed = false;
    while (!input_.empty()) {
        const bool move = input_.front().kind == InputEvent::Kind::kCursor;
        if (changed || (moved && !move)) return;
        moved = moved || move;
        changed = changed || !move;
        const InputEvent event = input_.front();
        input_.pop_front();
        handle(event);
    }
}

void Viewer::handle(const InputEvent& event) {
    redraw_ = kFramesToSettle;
    interface_.handle(event);
    const bool over_panel = interface_.wants_mouse() && !state_.navigation.dragging() && !dragging_divider_;
    switch (event.kind) {
        case InputEvent::Kind::kDrop: {
            Command open{"open", {}, event.line};
            for (const std::filesystem::path& file : event.files)
                open.arguments.push_back(file.string());
            commands_.push_back(std::move(open));
            return;
        }
        case InputEvent::Kind::kText:
            return;
        case InputEvent::Kind::kFocus:
            dragging_divider_ = false;
            break;
        case InputEvent::Kind::kKey:
            if (event.pressed && (interface_.wants_keyboard() || handle_key(event))) return;
            break;
        case InputEvent::Kind::kButton:
            if (over_panel && event.pressed) return;
            if (handle_divider(event)) return;
            if (event.pressed && !state_.navigation.dragging()) dragged_area_ = area_at(event.x);
            break;
        case InputEvent::Kind::kWheel:
            if (over_panel) return;
            break;
        case InputEvent::Kind::kCursor:
            if (handle_divider(event)) return;
            if (!state_.navigation.dragging()) dragged_area_ = area_at(event.x);
            break;
    }
    if (!state_.scene) return;
    const Camera before = state_.camera.camera();
    const std::size_t index = dragged_area_;
    state_.navigation.handle(event, area(index), state_.camera,
                             [&](const glm::dvec2& place) { return surface_at(index, place); });
    if (!(state_.camera.camera() == before)) moved_at_ = now_;
    if (const auto place = state_.navigation.take_click()) pick_at(*place);
}

bool Viewer::handle_divider(const InputEvent& event) {
    if (state_.comparison != Comparison::kWipe || !state_.scene) return false;
    const PictureArea picture = area(0);
    const double x = event.x * picture.scale - picture.x;
    if (event.kind == InputEvent::Kind::kButton && event.code == static_cast<int>(Button::kLeft)) {
        if (!event.pressed) return std::exchange(dragging_divider_, false);
        dragging_divider_ = std::abs(x - state_.wipe * picture.size.width) <= kDividerPixels * picture.scale;
        return dragging_divider_;
    }
    if (event.kind != InputEvent::Kind::kCursor || !dragging_divider_) return false;
    state_.wipe = std::clamp(x / picture.size.width, 0.0, 1.0);
    return true;
}

bool Viewer::handle_key(const InputEvent& event) {
    const bool flying = state_.navigation.dragging();
    const auto command = [&](const char* name, std::vector<std::string> arguments = {}) {
        commands_.push_back({name, std::move(arguments), event.line});
        return true;
    };
    if (event.repeated) return false;
    if (event.code == key_of_name("tab")) return command("panels", {state_.panels ? "off" : "on"});
    if (event.code == key_of_name("escape")) state_.messages.clear();
    if (flying) return false;
    switch (event.code) {
        case 'V':
            return command("next-view", {(event.modifiers & kShift) != 0 ? "-1" : "1"});
        case 'R':
            return command("rebake");
        case 'P':
            return command("screenshot");
        case 'C':
            return command("copy-camera");
        case 'X': {
            const auto next = (static_cast<std::size_t>(state_.comparison) + 1) % kComparisonNames.size();
            return command("compare", {std::string(kComparisonNames[next].name)});
        }
        case 'G':
            state_.graph_window = !state_.graph_window;
            return true;
        default:
            return false;
    }
}

std::optional<glm::dvec3> Viewer::surface_at(std::size_t index, const glm::dvec2& place) const {
    if (!state_.scene) return std::nullopt;
    const Ray ray = ray_through(state_.camera.camera(), area(index).size, place.x, place.y);
    const auto hit =
        pick(state_.scene->pickable, ray, {.sides = state_.looks[index].sides, .shown = state_.looks[index].shown});
    if (!hit) return std::nullopt;
    return hit->point;
}

void Viewer::pick_at(const glm::dvec2& place) {
    const std::size_t index = dragged_area_;
    const Ray ray = ray_through(state_.camera.camera(), area(index).size, place.x, place.y);
    state_.picked =
        pick(state_.scene->pickable, ray, {.sides = state_.looks[index].sides, .shown = state_.looks[index].shown});
}

}  // namespace splice
