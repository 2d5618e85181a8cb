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
                             const FrameRequest& want, double time, std::optional<Scene> made)
    : options_(options),
      between_(check_interrupt),
      scene_(made ? AnimatedScene(std::move(*made)) : open_animated_scene(options, time)) {
    rig_ = light_scene(options, scene_);
    camera_ = choose_camera(options, scene_.scene());
    between_();
    RenderSettings settings =
        settings_within_budget(options, budget, {scene_.scene(), camera_, time});
    settings.want = want;
    renderer_.emplace(scene_.scene(), settings);
    between_();
}

void SceneRenderer::expose_automatically(double time, const std::string& of_what) {
    const RenderSettings wanted = renderer_->settings();
    RenderSettings settings = wanted;
    settings.want = radiance_only();
    renderer_->change(settings);
    const Frame frame = render(time);
    settings = wanted;
    settings.exposure = options_.settings.exposure = automatic_exposure(frame.radiance);
    renderer_->change(settings);
    note(fmt::format("exposure {} EV (automatic{}): --exposure {} makes it again",
                     settings.exposure, of_what, settings.exposure));
}

Frame SceneRenderer::render(double time) {
    scene_.set_time(time);
    camera_ = choose_camera(options_, scene_.scene());
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
        camera_ = choose_camera(options_, scene_.scene());
        RenderSettings settings =
            settings_within_budget(options_, budget, {scene_.scene(), camera_, options_.time});
        settings.want = want;
        renderer_->change(settings);
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
