// SPDX-License-Identifier: Apache-2.0
#include "present/commands/scene_renderer.h"

#include <fmt/format.h>

#include <utility>

#include "host/base/interrupt.h"
#include "host/base/log.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/kernel_choice.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench.h"
#include "present/image/automatic_exposure.h"

namespace kilolux {

SceneRenderer::SceneRenderer(SharedOptions& options, const BudgetOptions& budget,
                             const FrameRequest& want, const FirstPicture& first,
                             std::optional<Scene> made)
    : options_(options),
      motion_(first.motion),
      between_(check_interrupt),
      scene_(made ? AnimatedScene(std::move(*made)) : open_animated_scene(options, first.time)) {
    rig_ = light_scene(options, scene_);
    camera_ = camera_at(first.time, first.frame);
    between_();
    renderer_.emplace(scene_.scene(), settings_for(budget, want, first.time));
    between_();
}

Camera SceneRenderer::camera_at(double time, int frame) const {
    if (motion_ == nullptr) return choose_camera(options_, scene_.scene());
    return motion_->at(scene_.scene(), frame, time);
}

RenderSettings SceneRenderer::settings_for(const BudgetOptions& budget, const FrameRequest& want,
                                           double time) {
    RenderSettings settings =
        settings_within_budget(options_, budget, {scene_.scene(), camera_, time});
    settings.want = want;
    settings.background = options_.shown_background;
    settings.reflections = options_.maps;
    return settings;
}

void SceneRenderer::expose_automatically(double time, const std::string& of_what, int frame) {
    const RenderSettings wanted = renderer_->settings();
    RenderSettings settings = wanted;
    settings.want = radiance_only();
    settings.background.reset();
    renderer_->change(settings);
    const Frame picture = render(time, frame);
    settings = wanted;
    settings.exposure = options_.settings.exposure = automatic_exposure(picture.radiance);
    renderer_->change(settings);
    note(fmt::format("exposure {} EV (automatic{}): --exposure {} makes it again",
                     settings.exposure, of_what, settings.exposure));
}

Frame SceneRenderer::render(double time, int frame) {
    scene_.set_time(time);
    camera_ = camera_at(time, frame);
    return renderer_->render(camera_, time, between_);
}

void SceneRenderer::relight(SharedOptions& options) {
    scene_.replace_lights({});
    rig_ = light_scene(options, scene_);
    scene_.add_lights(lights_);
}

void SceneRenderer::change(const SharedOptions& next, const BudgetOptions& budget,
                           const FrameRequest& want, bool relights) {
    const SharedOptions former = std::exchange(options_, next);
    const std::vector<SceneLight> added = scene_.added_lights();
    const std::string rig = rig_;
    try {
        if (relights) relight(options_);
        camera_ = camera_at(options_.time, 0);
        renderer_->change(settings_for(budget, want, options_.time));
        renderer_->refit();
    } catch (...) {
        options_ = former;
        rig_ = rig;
        if (relights) scene_.replace_lights(added);
        throw;
    }
}

void SceneRenderer::set_lights(std::vector<SceneLight> lights) {
    std::vector<SceneLight> all = scene_.added_lights();
    all.resize(all.size() - lights_.size());
    all.insert(all.end(), lights.begin(), lights.end());
    scene_.replace_lights(std::move(all));
    lights_ = std::move(lights);
    renderer_->refit();
}

void SceneRenderer::fill_limits(FrameRecord& record) {
    if (!limits_) {
        limits_ = cached_device_limits(Gpu(choose_device(renderer_->settings().device)));
    }
    kilolux::fill_limits(
        record.stats, *limits_,
        frame_setup(renderer_->settings(), renderer_->plan(), renderer_->device()));
}

nlohmann::ordered_json SceneRenderer::stats(FrameRecord record, bool limits) {
    if (limits) fill_limits(record);
    auto document = stats_json(renderer_->device(), renderer_->plan(), record);
    document["program"] = program_json();
    document["tuning"] =
        tuning_json(choose_tuning(renderer_->device(), renderer_->settings().kernels));
    return document;
}

}  // namespace kilolux
