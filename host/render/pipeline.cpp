// SPDX-License-Identifier: Apache-2.0
#include "host/render/pipeline.h"

#include <utility>

#include "host/base/error.h"
#include "host/render/plan/kernel_choice.h"

namespace kilolux {
namespace {

// The settings of the same picture with every light at every pixel.
RenderSettings reference_of(RenderSettings settings) {
    settings.renderer = RendererKind::deferred_all;
    settings.want = radiance_only();
    settings.background.reset();  // differences are those of surfaces
    settings.light_groups.clear();
    return settings;
}

}  // namespace

Pipeline::Pipeline(std::shared_ptr<RenderScene> scene, const RenderSettings& settings,
                   const Gpu& opened)
    : context(make_context(std::move(scene), settings, opened)),
      lights(context.gpu, context.tuning, context.scene->scene(), settings),
      samples(context.gpu, context.tuning),
      picture(context),
      reader(context) {
    take_up_settings();
}

Pipeline::~Pipeline() { context.scene->make_current_or_lost(); }

// Makes the parts that the settings need and that are missing.
void Pipeline::take_up_settings() {
    const RenderSettings& settings = context.settings;
    const RendererKind kind = settings.renderer;
    if (settings.reflections && is_forward(kind)) {
        throw Error("reflections: the forward renderers have none; deferred and deferred-all do");
    }
    if (!stages.contains(kind)) stages.try_emplace(kind, context);
    picture.set(settings);
    environment.set(context);
    if (settings.want.view == ViewKind::difference) {
        change(reference, context.scene, reference_of(settings));
    }
}

// Whether other settings need neither other kernels nor another device.
bool Pipeline::is_built_for(const RenderSettings& wanted) const {
    const RenderSettings& settings = context.settings;
    return wanted.device == settings.device && wanted.geometry == settings.geometry &&
           wanted.anisotropy == settings.anisotropy && wanted.kernels == settings.kernels &&
           plan_of(context.scene->scene(), wanted) == context.plan &&
           draws_in_opencl(*context.scene, wanted, context.tuning) == context.draws_in_opencl;
}

void Pipeline::take(const RenderSettings& next) {
    const RenderSettings former = std::exchange(context.settings, next);
    const MemoryPlan former_memory = context.memory;
    const auto hold = [&](const MemoryPlan& plan) {
        context.memory = plan;
        context.gpu.budget->limit = plan.device_bytes;
    };
    try {
        hold(plan_memory(context.scene->scene(), next, context.plan, context.gpu.info,
                         context.draws_in_opencl));
        take_up_settings();
    } catch (...) {
        context.settings = former;
        hold(former_memory);
        picture.set(former);
        environment.set(context);
        throw;
    }
    lights.set_generated(next.lights);
    lights.set_tails(next);
    lights.set_groups(next.light_groups);
    lights.set_mix(next.light_mix);
}

void Pipeline::change(std::unique_ptr<Pipeline>& pipeline,
                      const std::shared_ptr<RenderScene>& scene, const RenderSettings& settings) {
    if (pipeline && pipeline->is_built_for(settings)) {
        return pipeline->take(settings);
    }
    // Programs that both need are built already; but a device that failed is opened anew.
    const bool same_device = pipeline && pipeline->last.is_sound &&
                             pipeline->context.settings.device == settings.device &&
                             pipeline->context.settings.opened == settings.opened;
    pipeline = std::make_unique<Pipeline>(
        scene, settings,
        same_device ? device_for(settings, pipeline->context.gpu) : open_device(settings));
}

}  // namespace kilolux
