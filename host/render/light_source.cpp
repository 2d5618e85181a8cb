// SPDX-License-Identifier: Apache-2.0
#include "host/render/light_source.h"

#include "host/base/log.h"
#include "host/render/light_order.h"
#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

std::vector<SceneLight> lights_with_ranges(const Scene& scene, double budget) {
    std::vector<SceneLight> lights = scene.lights;
    if (const std::size_t filled = fill_missing_ranges(lights, budget); filled > 0) {
        note(scene.name + ": " + std::to_string(filled) +
             " lights without a range got one from their intensity, error at most " +
             std::to_string(budget) + " each");
    }
    return lights;
}

std::vector<SceneLight> with_generated(std::vector<SceneLight> lights, const LightOptions& options,
                                       const Scene& scene, double time) {
    const std::vector<SceneLight> generated = generate_lights(options, scene, time);
    lights.insert(lights.end(), generated.begin(), generated.end());
    sort_by_place(lights);
    return lights;
}

}  // namespace

std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings, double time) {
    std::vector<SceneLight> lights = scene.lights;
    fill_missing_ranges(lights, settings.range_budget);
    return with_generated(std::move(lights), settings.lights, scene, time);
}

LightSource::LightSource(const Gpu& gpu, const Scene& scene, const RenderSettings& settings)
    : gpu_(gpu),
      scene_(scene),
      revision_(scene.revision),
      range_budget_(settings.range_budget),
      generated_(settings.lights),
      own_(lights_with_ranges(scene, settings.range_budget)),
      local_(gpu, "lights"),
      directional_(gpu, "lights") {}

void LightSource::set_generated(const LightOptions& generated) {
    if (generated == generated_) return;
    generated_ = generated;
    time_.reset();
}

// The scene's own lights anew where they moved.
void LightSource::take_up_changes() {
    if (revision_ == scene_.revision) return;
    revision_ = scene_.revision;
    own_ = scene_.lights;
    fill_missing_ranges(own_, range_budget_);
    time_.reset();
}

LightRows LightSource::at(double time, const glm::dvec3& camera_position, FrameStats& stats) {
    take_up_changes();
    if (time_ != time) {
        lights_ = with_generated(own_, generated_, scene_, time);
        time_ = time;
    }
    LightRows rows = make_light_rows(lights_, camera_position);
    stats.lights_given = lights_.size();
    stats.lights_rejected = rows.rejected;
    stats.lights_used = rows.local.size() + rows.directional.size();
    stats.directional_lights = rows.directional.size();
    stats.lights_dropped = lights_.size() - rows.rejected - stats.lights_used;
    return rows;
}

LightInput LightSource::upload(const LightRows& rows) {
    LightInput input;
    input.count = static_cast<uint>(rows.local.size());
    input.directional_count = static_cast<uint>(rows.directional.size());
    input.lights = local_.reserve(rows.local.size());
    input.directional = directional_.reserve(rows.directional.size());
    kilolux::upload<Light>(gpu_, input.lights, rows.local);
    kilolux::upload<DirectionalLight>(gpu_, input.directional, rows.directional);
    return input;
}

}  // namespace kilolux
