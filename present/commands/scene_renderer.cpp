// SPDX-License-Identifier: Apache-2.0
#include "present/commands/scene_renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/plan/kernel_choice.h"
#include "present/cli/scene_choice.h"
#include "present/commands/bench/bench_context.h"
#include "present/image/automatic_exposure.h"

namespace kilolux {

void check_budget(SharedOptions& options, const BudgetOptions& budget) {
    if (!budget.max_error) return;
    if (options.reflections) {
        throw UsageError("--max-error and --reflections exclude each other");
    }
    options.shows_environment = false;
}

RenderSettings before_white(RenderSettings settings) {
    const FrameRequest want = settings.want;
    settings.want = radiance_only();
    settings.want.strip_makers = want.strip_makers;
    settings.want.crop_pixels = want.crop_pixels;
    settings.background = std::make_shared<const Environment>(Environment{1, 1, {glm::vec3(1.0f)}});
    return settings;
}

std::vector<float> coverage_of(const Frame& black, const Frame& white) {
    std::vector<float> out;
    for (std::size_t i = 1; i < black.radiance.size(); i += 3) {
        out.push_back(1.0f - std::clamp(white.radiance[i] - black.radiance[i], 0.0f, 1.0f));
    }
    return out;
}

SceneRenderer::SceneRenderer(SharedOptions& options, const BudgetOptions& budget,
                             FirstPicture first)
    : options_(options),
      device_(open_device_async(options.settings)),
      camera_at_(std::move(first.camera)),
      scene_(first.made ? AnimatedScene(std::move(*first.made)) : open_animated_scene(options)) {
    if (!camera_at_) {
        camera_at_ = [this](const Scene& scene, int, double) {
            return choose_camera(options_, scene);
        };
    }
    scene_.set_time(first.time);
    asked_ = Asked(options.settings);
    rig_ = light_scene(options, scene_);
    camera_ = camera_at_(scene_.scene(), first.frame, first.time);
    check_interrupt();
    const RenderSettings settings = settings_of(budget, first.want, first.time);
    // Before the helpers, which may change the environment.
    const Gpu device = in_stage("renderer", [this] { return device_.get(); });
    if (first.on_lit) helpers_ = first.on_lit(scene_.scene(), settings);
    renderer_.emplace(scene_.scene(), settings, device);
    check_interrupt();
}

// Chooses for the present camera.
RenderSettings SceneRenderer::settings_of(const BudgetOptions& budget, const FrameRequest& want,
                                          double time) {
    RenderSettings settings =
        settings_within_budget(options_, budget, {scene_.scene(), camera_, time});
    settings.want = want;
    settings.background = options_.shown_background;
    settings.reflections = options_.maps;
    return settings;
}

void SceneRenderer::expose_automatically(double time, int frame, const std::string& of_what) {
    const RenderSettings wanted = renderer_->settings();
    RenderSettings settings = wanted;
    settings.want = radiance_only();
    settings.want.strip_makers = 1;
    settings.background.reset();
    renderer_->change(settings);
    place(time, frame);
    ExposureMeter meter;
    const std::vector<Band> strips = renderer_->strips();
    for (const Band& rows : strips) {
        const Frame picture = strips.size() == 1 ? renderer_->render(camera_, time)
                                                 : renderer_->render_strip(camera_, time, rows);
        meter.add(picture.radiance);
    }
    settings = wanted;
    settings.exposure = options_.settings.exposure = meter.exposure();
    renderer_->change(settings);
    note(fmt::format("exposure {} EV (automatic{}): --exposure {} makes it again",
                     settings.exposure, of_what, settings.exposure));
}

void SceneRenderer::place(double time, int frame) {
    scene_.set_time(time);
    camera_ = camera_at_(scene_.scene(), frame, time);
}

Frame SceneRenderer::render(double time, int frame, const std::optional<PixelRect>& crop) {
    place(time, frame);
    return crop ? renderer_->render_crop(camera_, time, *crop) : renderer_->render(camera_, time);
}

std::vector<float> SceneRenderer::coverage(const Frame& picture, double time, int frame,
                                           const std::optional<PixelRect>& crop) {
    const RenderSettings wanted = renderer_->settings();
    renderer_->change(before_white(wanted));
    const Frame white = render(time, frame, crop);
    renderer_->change(wanted);
    return coverage_of(picture, white);
}

void SceneRenderer::relight(SharedOptions& options) {
    scene_.replace_lights({});
    rig_ = light_scene(options, scene_);
    scene_.add_lights(lights_);
}

// Chooses whether surfaces are lights, and the tails for all lights that the scene has now, where
// the options leave it open.
void SceneRenderer::choose_for_lights() {
    choose_emissive_lights(options_, scene_);
    choose_light_groups(options_, scene_.scene());
    options_.settings.tails = asked_.tails;
    options_.settings.range_budget = asked_.range_budget;
    kilolux::choose_tails(options_, scene_.scene());
}

void SceneRenderer::change(const SharedOptions& next, const BudgetOptions& budget,
                           const FrameRequest& want, bool relights) {
    const SharedOptions former = std::exchange(options_, next);
    const Asked asked = asked_;
    const std::vector<SceneLight> added = scene_.added_lights();
    const bool glowed = scene_.glow() != nullptr;
    const std::string rig = rig_;
    const Camera camera = camera_;
    try {
        asked_ = Asked(next.settings);
        if (relights) relight(options_);
        choose_for_lights();
        camera_ = camera_at_(scene_.scene(), 0, options_.time);
        renderer_->change(settings_of(budget, want, options_.time));
        renderer_->refit();
    } catch (...) {
        options_ = former;
        asked_ = asked;
        rig_ = rig;
        camera_ = camera;
        if (relights) scene_.replace_lights(added);
        scene_.light_by_surfaces(glowed);
        throw;
    }
}

void SceneRenderer::set_lights(std::vector<SceneLight> lights) {
    std::vector<SceneLight> all = scene_.added_lights();
    all.resize(all.size() - lights_.size());
    all.insert(all.end(), lights.begin(), lights.end());
    scene_.replace_lights(all);
    lights_ = std::move(lights);
    choose_for_lights();
    RenderSettings settings = renderer_->settings();
    settings.tails = options_.settings.tails;
    settings.range_budget = options_.settings.range_budget;
    settings.light_groups = options_.settings.light_groups;
    settings.light_mix = options_.settings.light_mix;
    renderer_->change(settings);
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
