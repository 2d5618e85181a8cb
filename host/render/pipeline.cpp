// SPDX-License-Identifier: Apache-2.0
#include "host/render/pipeline.h"

#include <utility>

#include "host/render/kernel_choice.h"
#include "host/render/renderer.h"

namespace kilolux {
namespace {

// The same picture with every light at every pixel.
RenderSettings reference_of(RenderSettings settings) {
    settings.renderer = RendererKind::deferred_all;
    settings.want = radiance_only();
    settings.background.reset();  // differences are those of surfaces
    return settings;
}

// Holds the buffers of everything that gets the device from now on within the plan.
MemoryPlan limit_buffers(Gpu& gpu, const MemoryPlan& plan) {
    gpu.budget = std::make_shared<MemoryBudget>(MemoryBudget{plan.device_bytes, 0});
    return plan;
}

ScenePlan plan_of(const Scene& scene, const RenderSettings& settings) {
    return make_scene_plan(scene, settings, settings.lights.count + scene.lights.size());
}

// Throws when its pictures cannot fit, before anything large is uploaded.
void check_memory(const Scene& scene, const RenderSettings& settings) {
    const cl::Device device =
        settings.opened ? settings.opened->device : choose_device(settings.device);
    plan_memory(scene, settings, plan_of(scene, settings), describe(device));
}

}  // namespace

Pipeline::Pipeline(std::shared_ptr<RenderScene> the_scene, const RenderSettings& the_settings,
                   Gpu opened)
    : scene(std::move(the_scene)),
      settings(the_settings),
      plan(plan_of(scene->scene(), settings)),
      gpu(std::move(opened)),
      memory(limit_buffers(gpu, plan_memory(scene->scene(), settings, plan, gpu.info))),
      tuning_(choose_tuning(describe(gpu.device), settings.kernels).tuning),
      lights_(gpu, tuning_, scene->scene(), settings),
      context_{settings,       plan,          gpu,          tuning_,      *scene,
               surface_scene_, shadow_scene_, &background_, &reflections_},
      tonemap_(gpu, tuning_, static_cast<int>(settings.tone_curve)),
      whole_light_(gpu, "bloom"),
      reader_(gpu),
      shown_(gpu) {
    make_optional_parts();
    make_background();
    make_reflections();
}

Pipeline::~Pipeline() { scene->make_current_or_lost(); }

// What some settings need and others do not.
void Pipeline::make_optional_parts() {
    const RendererKind kind = settings.renderer;
    if (settings.reflections && is_forward(kind)) {
        throw Error("reflections: the forward renderers have none; deferred and deferred-all do");
    }
    if (!paths_.contains(kind)) {
        if (is_forward(kind)) {
            paths_.try_emplace(kind, std::in_place_type<ForwardPath>, context_);
        } else if (kind == RendererKind::deferred) {
            paths_.try_emplace(kind, std::in_place_type<DeferredPath>, context_);
        } else {
            paths_.try_emplace(kind, std::in_place_type<DeferredAllPath>, context_);
        }
    }
    const ViewKind view = settings.want.view;
    if (settings.bloom > 0.0f && !bloom_) bloom_.emplace(gpu);
    if (view == ViewKind::overdraw && !overdraw_) overdraw_.emplace(context_.meshes());
    if (view == ViewKind::difference) change(reference_, scene, reference_of(settings));
}

// After a failure the former one stays.
void Pipeline::make_background() {
    if (!settings.background) return background_.reset();
    const Environment& image = *settings.background;
    FillBackground next(gpu, tuning_);
    next.set_image({&image.rows.data()->x, 3 * image.rows.size()}, static_cast<uint>(image.width),
                   static_cast<uint>(image.height));
    background_.emplace(std::move(next));
}

void Pipeline::make_reflections() {
    if (!settings.reflections) return reflections_.reset();
    const PrefilteredEnvironment& maps = *settings.reflections;
    ReflectEnvironment next(gpu, tuning_, plan.kernels);
    next.set_maps({maps.texels, maps.levels, maps.table, maps.table_size});
    reflections_.emplace(std::move(next));
}

// Whether other settings need neither other kernels nor another device.
bool Pipeline::is_built_for(const RenderSettings& other) const {
    return other.device == settings.device && other.geometry == settings.geometry &&
           other.anisotropy == settings.anisotropy && other.kernels == settings.kernels &&
           plan_of(scene->scene(), other) == plan;
}

void Pipeline::take(const RenderSettings& next) {
    const RenderSettings former = std::exchange(settings, next);
    const MemoryPlan former_memory = memory;
    try {
        memory = plan_memory(scene->scene(), settings, plan, gpu.info);
        gpu.budget->limit = memory.device_bytes;
        make_optional_parts();
        if (next.tone_curve != former.tone_curve) {
            tonemap_ = Tonemap(gpu, tuning_, static_cast<int>(next.tone_curve));
        }
        if (next.reflections != former.reflections) make_reflections();
        if (next.background != former.background) make_background();
    } catch (...) {
        settings = former;
        memory = former_memory;
        gpu.budget->limit = memory.device_bytes;
        throw;
    }
    lights_.set_generated(next.lights);
    lights_.set_tails(next);
}

void Pipeline::change(std::unique_ptr<Pipeline>& pipeline,
                      const std::shared_ptr<RenderScene>& scene, const RenderSettings& settings) {
    if (pipeline && pipeline->is_built_for(settings)) {
        return pipeline->take(settings);
    }
    // The programs that both need are built; but a device that failed is opened anew.
    const bool same_device = pipeline && pipeline->is_sound_ &&
                             pipeline->settings.device == settings.device &&
                             pipeline->settings.opened == settings.opened;
    pipeline = std::make_unique<Pipeline>(
        scene, settings, same_device ? device_for(settings, pipeline->gpu) : open_device(settings));
}

std::shared_ptr<RenderScene> shared_scene(const Scene& scene, GlSource gl) {
    return std::make_shared<RenderScene>(scene, gl == GlSource::headless);
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : Renderer(shared_scene(scene, gl), settings) {}
Renderer::Renderer(std::shared_ptr<RenderScene> scene, const RenderSettings& settings)
    : pipeline_(in_stage("renderer", [&] {
          check_memory(scene->scene(), settings);
          scene->make_current();
          return std::make_unique<Pipeline>(std::move(scene), settings, open_device(settings));
      })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::change(const RenderSettings& settings) {
    if (settings == pipeline_->settings) return;
    pipeline_->scene->make_current();
    in_stage("settings", [&] { Pipeline::change(pipeline_, pipeline_->scene, settings); });
}

void Renderer::refit() {
    pipeline_->scene->make_current();
    const RenderSettings settings = pipeline_->settings;
    in_stage("lights", [&] { Pipeline::change(pipeline_, pipeline_->scene, settings); });
}

}  // namespace kilolux
