#include "engine/capture/look_settings.h"

namespace splice {

void apply_look(const SceneLook& look, CaptureSettings& settings) {
    settings.view = look.view;
    settings.shown = look.shown;
    settings.backend = look.backend;
    settings.sides = look.sides;
    settings.epsilon_scale = look.epsilon_scale;
    settings.prefilter = look.prefilter;
    settings.antialias = look.antialias;
    settings.shading = look.shading;
    settings.merge_px = look.merge_px;
    settings.tau = look.tau;
    settings.kernel = look.kernel;
}

SceneLook look_of(const CaptureSettings& settings) {
    return {.view = settings.view,
            .shown = settings.shown,
            .backend = settings.backend,
            .sides = settings.sides,
            .epsilon_scale = settings.epsilon_scale,
            .prefilter = settings.prefilter,
            .antialias = settings.antialias,
            .shading = settings.shading,
            .merge_px = settings.merge_px,
            .tau = settings.tau,
            .kernel = settings.kernel};
}

}  // namespace splice
