#include "engine/viewer/scene_job.h"

#include <exception>
#include <new>
#include <utility>

namespace splice {

namespace {

struct Cancelled : std::exception {};

}  // namespace

SceneJob::SceneJob(SceneRequest request) : request_(std::move(request)), thread_([this] { run(); }) {}

SceneJob::~SceneJob() {
    cancelled_ = true;
    thread_.join();
}

SceneJob::Progress SceneJob::progress() const {
    const std::scoped_lock lock(mutex_);
    return progress_;
}

std::optional<SceneJob::Outcome> SceneJob::take_outcome() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
}

void SceneJob::run() {
    Outcome outcome{request_, std::nullopt, ""};
    try {
        outcome.scene = prepare_scene(request_.paths, request_.options, [this](std::string_view stage, double share) {
            if (cancelled_) throw Cancelled();
            const std::scoped_lock lock(mutex_);
            progress_ = {std::string(stage), share};
        });
    } catch (const Cancelled&) {
        outcome.error.clear();
    } catch (const std::bad_alloc&) {
        outcome.error = "out of memory";
    } catch (const std::exception& error) {
        outcome.error = error.what();
    }
    {
        const std::scoped_lock lock(mutex_);
        outcome_ = std::move(outcome);
    }
    ended_ = true;
}

}  // namespace splice
