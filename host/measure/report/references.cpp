// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/references.h"

#include <fmt/core.h>

#include <algorithm>

#include "host/measure/reference/decoded_samples.h"
#include "host/render/lights/light_rows.h"
#include "host/render/lights/light_source.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/renderer.h"
#include "host/scene/lights/light_ranges.h"

namespace kilolux {
namespace {

// Key of the lights' ranges: a tree's share does not change it, nor does a budget without ranges.
std::string ranges_key(const RenderSettings& s) {
    const bool everywhere = s.tails == Tails::exact || s.tails == Tails::tree;
    return fmt::format("{} {} {} {}", static_cast<int>(s.tails), everywhere ? 0.0 : s.range_budget,
                       s.lights.radius, s.lights.intensity);
}

// The settings whose G-buffer R1 shades. Forward shading quantises nothing, like the layout `full`,
// and its surfaces are those of `--geometry planes`.
RenderSettings decoded_settings(RenderSettings settings) {
    if (is_forward(settings.renderer)) {
        settings.gbuffer = GBUFFER_FULL;
        settings.geometry = Geometry::planes;
    }
    settings.renderer = RendererKind::deferred;
    return settings;
}

std::string kernels_key(const RenderSettings& s, const DeviceInfo& device) {
    return fmt::format("{} {} {} {} {} {} {}", s.gbuffer, static_cast<int>(s.geometry),
                       static_cast<int>(s.shading), s.shadows != Shadows::off, ranges_key(s),
                       device.name, device.driver);
}

ReferenceLights usable_lights(const ReportView& view, const RenderSettings& settings) {
    std::vector<SceneLight> lights = lights_at(view.scene, settings, view.camera, view.time);
    std::erase_if(lights,
                  [&](const SceneLight& light) { return !is_usable(light, view.camera.position); });
    return reference_lights(lights, view.camera, &view.scene);
}

}  // namespace

ReportReferences::ReportReferences(const ReportView& view, const RenderSettings& asked)
    : view_(view), asked_(asked) {
    if (asked.shadows != Shadows::off) {
        shadows_ = std::make_shared<const ShadowCaster>(view.scene, view.camera);
    }
}

ReferenceOptions ReportReferences::options_of(const RenderSettings& settings, bool windowed) const {
    const auto& plan = make_scene_plan(view_.scene, settings, 0).kernels;
    ReferenceOptions out = reference_options(plan, settings, view_.camera);
    out.windowed = windowed;
    out.progress = [this](double) { on_step_(); };
    if (settings.shadows != Shadows::off) out.shadows = shadows_;
    out.tinted_shadows = plan.tinted_shadows;
    return out;
}

const ComparedReference& ReportReferences::kernels(const RenderSettings& settings,
                                                   const ReportDevice& device) {
    const RenderSettings decoded = decoded_settings(settings);
    const std::string key = kernels_key(decoded, device.gpu->info);
    const std::scoped_lock lock(mutex_);
    if (const auto found = kernels_.find(key); found != kernels_.end()) return found->second;
    on_step_();
    auto made = has_blended_surfaces(view_.scene) ? cast_reference(decoded, decoded, true)
                                                  : decoded_reference(decoded, device);
    return kernels_.emplace(key, std::move(made)).first->second;  // whole: the device may fail
}

ComparedReference ReportReferences::decoded_reference(const RenderSettings& decoded,
                                                      const ReportDevice& device) {
    RenderSettings exact = decoded;
    exact.kernels = {};
    exact.shadows = Shadows::off;  // only surfaces and lights are read
    exact.opened = device.gpu;
    Renderer renderer(device.opened, exact);
    renderer.render(view_.camera, view_.time);
    return compared_reference(shade_reference(renderer.lit_surfaces(), options_of(decoded, true)),
                              asked_);
}

ComparedReference ReportReferences::cast_reference(const RenderSettings& lights,
                                                   const RenderSettings& shading, bool windowed) {
    return compared_reference(
        shade_reference(cast(), usable_lights(view_, lights), options_of(shading, windowed)),
        asked_);
}

const std::vector<SurfaceSamples>& ReportReferences::cast() {
    if (cast_.empty()) {
        cast_ = RayCaster(view_.scene)
                    .cast_layers(view_.camera, asked_.width, asked_.height,
                                 [this](double) { on_step_(); });
    }
    return cast_;
}

const ComparedReference& ReportReferences::surfaces(const RenderSettings& settings) {
    const std::string key = ranges_key(settings);
    const std::scoped_lock lock(mutex_);
    if (const auto found = surfaces_.find(key); found != surfaces_.end()) return found->second;
    return surfaces_.emplace(key, cast_reference(settings, asked_, true)).first->second;
}

const ComparedReference& ReportReferences::rasterised(const RenderSettings& settings,
                                                      const ReportDevice& device) {
    RenderSettings full = settings;
    full.gbuffer = GBUFFER_FULL;
    full.shading = asked_.shading;
    full.shadows = asked_.shadows;
    return kernels(full, device);
}

const ComparedReference& ReportReferences::unbounded() {
    const std::scoped_lock lock(mutex_);
    if (!unbounded_) unbounded_ = cast_reference(asked_, asked_, false);
    return *unbounded_;
}

const ComparedReference& ReportReferences::unlimited(const RenderSettings& settings,
                                                     const ReportDevice& device) {
    RenderSettings exact = settings;
    if (std::ranges::any_of(view_.scene.lights, lacks_range)) exact.tails = Tails::exact;
    return kernels(exact, device);
}

const MeanPicture& ReportReferences::mean(const ReportDevice& device) {
    const std::string key = device.gpu->info.name + ' ' + device.gpu->info.driver;
    const std::scoped_lock lock(mutex_);
    if (const auto found = means_.find(key); found != means_.end()) return found->second;
    RenderSettings settings = asked_;
    settings.opened = device.gpu;
    MeanPicture made =
        mean_picture(device.opened, view_.camera, view_.time, settings, {}, on_step_);
    return means_.emplace(key, std::move(made)).first->second;
}

std::optional<std::uint64_t> missed_lights(const DecodedSurfaces& found,
                                           const ReferencePicture& reference) {
    if (found.covering.empty()) return std::nullopt;
    std::uint64_t missed = 0;
    for (std::size_t y = 0; y < found.view.height; ++y) {
        for (std::size_t x = 0; x < found.view.width; ++x) {
            const uint covering = found.covering[y * found.view.stride + x];
            const uint wanted = reference.reaching[y * found.view.width + x];
            if (covering != kBackground && covering < wanted) missed += wanted - covering;
        }
    }
    return missed;
}

}  // namespace kilolux
