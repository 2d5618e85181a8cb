// SPDX-License-Identifier: Apache-2.0
// Making a renderer, and changing its settings.
#include <utility>

#include "host/render/kernel_choice.h"
#include "host/render/renderer_parts.h"

namespace kilolux {
namespace {

// The same picture with every light at every pixel.
RenderSettings reference_of(RenderSettings settings) {
    settings.renderer = RendererKind::deferred_all;
    settings.show = "lit";
    settings.aovs.clear();
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
const Scene& checked(const Scene& scene, const RenderSettings& settings) {
    plan_memory(scene, settings, plan_of(scene, settings),
                describe(choose_device(settings.device)));
    return scene;
}

}  // namespace

Renderer::Parts::Parts(std::shared_ptr<RenderScene> the_scene, const RenderSettings& the_settings)
    : scene(std::move(the_scene)),
      settings(the_settings),
      plan(plan_of(scene->scene(), settings)),
      gpu(open_device(settings)),
      memory(limit_buffers(gpu, plan_memory(scene->scene(), settings, plan, gpu.info))),
      tuning(choose_tuning(describe(gpu.device), settings.kernels).tuning),
      lights(gpu, scene->scene(), settings),
      context{settings, plan, gpu, tuning, scene->meshes(), scene->box()},
      sum(gpu),
      tonemap(gpu, tuning, static_cast<int>(settings.tone_curve)) {
    make_optional_parts();
}

Renderer::Parts::~Parts() { scene->make_current_or_lost(); }

// What some settings need and others do not.
void Renderer::Parts::make_optional_parts() {
    const RendererKind kind = settings.renderer;
    if (is_forward(kind)) {
        if (!forward.contains(kind)) forward.try_emplace(kind, context);
    } else if (!deferred.contains(kind)) {
        deferred.try_emplace(kind, context);
    }
    if (settings.bloom > 0.0f && !bloom) bloom.emplace(gpu);
    if (settings.show == "overdraw" && !overdraw) overdraw.emplace(scene->meshes());
    if (settings.show == "difference") change(reference, scene, reference_of(settings));
}

// Whether other settings need neither other kernels nor another device.
bool Renderer::Parts::is_built_for(const RenderSettings& other) const {
    return other.device == settings.device && other.kernels == settings.kernels &&
           other.range_budget == settings.range_budget && plan_of(scene->scene(), other) == plan;
}

void Renderer::Parts::take(const RenderSettings& next) {
    const RenderSettings former = std::exchange(settings, next);
    const MemoryPlan former_memory = memory;
    try {
        memory = plan_memory(scene->scene(), settings, plan, gpu.info);
        gpu.budget->limit = memory.device_bytes;
        make_optional_parts();
        if (next.tone_curve != former.tone_curve) {
            tonemap = Tonemap(gpu, tuning, static_cast<int>(next.tone_curve));
        }
    } catch (...) {
        settings = former;
        memory = former_memory;
        gpu.budget->limit = memory.device_bytes;
        throw;
    }
    lights.set_generated(next.lights);
}

void Renderer::Parts::change(std::unique_ptr<Parts>& parts,
                             const std::shared_ptr<RenderScene>& scene,
                             const RenderSettings& settings) {
    if (parts && parts->is_built_for(settings)) {
        parts->take(settings);
    } else {
        parts = std::make_unique<Parts>(scene, settings);
    }
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : parts_(in_stage("renderer", [&] {
          return std::make_unique<Parts>(
              std::make_shared<RenderScene>(checked(scene, settings), gl == GlSource::headless),
              settings);
      })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::change(const RenderSettings& settings) {
    if (settings == parts_->settings) return;
    parts_->scene->make_current();
    in_stage("settings", [&] { Parts::change(parts_, parts_->scene, settings); });
}

}  // namespace kilolux
