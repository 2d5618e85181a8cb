// SPDX-License-Identifier: Apache-2.0
#include "host/render/render_context.h"

#include "host/picture/bands.h"
#include "host/render/plan/grid_request.h"
#include "host/render/plan/kernel_choice.h"
#include "host/render/whole_picture.h"

namespace kilolux {
namespace {

// Most texture samples along a footprint's longer side.
int chosen_anisotropy(const RenderSettings& settings, const DeviceInfo& device) {
    constexpr int kGpuAnisotropy = 8;
    if (settings.anisotropy > 0) return settings.anisotropy;
    return device.is_cpu ? 1 : kGpuAnisotropy;
}

bool chooses_compute(const RenderContext& context) {
    const Geometry geometry = context.settings.geometry;
    if (geometry != Geometry::automatic) return geometry == Geometry::compute;
    return context.tuning.geometry == 1 || !context.scene->has_opengl();
}

}  // namespace

bool RenderContext::shades_display() const {
    const FrameRequest& want = settings.want;
    const bool is_one_sample = settings.samples <= 1 && !settings.auto_samples.on;
    const bool is_all = !settings.background && !settings.reflections &&
                        !needs_whole_picture(settings) && !blends();
    return settings.renderer == RendererKind::deferred && want.display && !want.radiance &&
           want.view == ViewKind::lit && is_one_sample && is_all &&
           !plan.kernels.fast_relaxed_math && !plan.kernels.native_math;
}

bool RenderContext::draws_in_opencl() const {
    return chooses_compute(*this) && resolves() && !blends();
}

bool RenderContext::is_whole() const {
    return make_bands(settings.height, memory.band_rows).size() == 1;
}

const GpuScene& RenderContext::meshes() const {
    return scene->meshes(resolves() ? GpuSceneUse::covered : GpuSceneUse::shaded,
                         chosen_anisotropy(settings, gpu.info));
}

SurfaceFeatures RenderContext::surface_features() const {
    return kilolux::surface_features(scene->scene(), plan.gbuffer,
                                     chosen_anisotropy(settings, gpu.info));
}

ClusterGrid RenderContext::coarse_grid(const Camera& camera) const {
    const uint layout = is_forward(settings.renderer) ? GBUFFER_PACKED : settings.gbuffer;
    const Box& box = scene->box();
    return make_cluster_grid(
        grid_request(settings.grid, camera, box, position_pad(layout, box, camera)),
        static_cast<uint>(settings.width), static_cast<uint>(settings.height));
}

ScenePlan plan_of(const Scene& scene, const RenderSettings& settings) {
    return make_scene_plan(scene, settings, settings.lights.count + scene.lights.size());
}

RenderContext make_context(std::shared_ptr<RenderScene> scene, const RenderSettings& settings,
                           const Gpu& opened) {
    const ScenePlan plan = plan_of(scene->scene(), settings);
    Gpu gpu = opened;
    const MemoryPlan memory = plan_memory(scene->scene(), settings, plan, gpu.info);
    gpu.budget = std::make_shared<MemoryBudget>(MemoryBudget{memory.device_bytes, 0});
    const Tuning tuning = choose_tuning(describe(gpu.device), settings.kernels).tuning;
    return {std::move(scene), settings, plan, gpu, tuning, memory};
}

}  // namespace kilolux
