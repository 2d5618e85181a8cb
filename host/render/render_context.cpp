// SPDX-License-Identifier: Apache-2.0
#include "host/render/render_context.h"

#include <fmt/format.h>

#include "host/base/log.h"
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

bool chooses_compute(const RenderScene& scene, const RenderSettings& settings,
                     const Tuning& tuning) {
    if (settings.geometry != Geometry::automatic) return settings.geometry == Geometry::compute;
    return tuning.geometry == 1 || settings.width > scene.opengl_limit();
}

// Says where OpenGL's limit decides.
void note_limit(const RenderScene& scene, const RenderSettings& settings, const Tuning& tuning) {
    const bool is_chosen = settings.geometry == Geometry::automatic && tuning.geometry != 1;
    if (!is_chosen || scene.opengl_limit() == 0) return;
    note(fmt::format("geometry  OpenCL draws: OpenGL draws {} pixels a side at most",
                     scene.opengl_limit()));
}

}  // namespace

bool RenderContext::shades_display() const {
    const FrameRequest& want = settings.want;
    const bool is_one_sample = settings.samples <= 1 && !settings.auto_samples.on;
    const bool is_all = !settings.background && !settings.reflections &&
                        !needs_whole_picture(settings) && !blends() &&
                        settings.light_groups.empty();
    return settings.renderer == RendererKind::deferred && want.display && !want.radiance &&
           want.view == ViewKind::lit && is_one_sample && is_all &&
           !plan.kernels.fast_relaxed_math && !plan.kernels.native_math;
}

bool RenderContext::is_whole() const {
    return make_bands(settings.height, memory.band_rows).size() == 1;
}

const GpuScene& RenderContext::meshes() const {
    return scene->meshes(resolves() ? GpuSceneUse::covered : GpuSceneUse::shaded,
                         chosen_anisotropy(settings, gpu.info));
}

SurfaceFeatures RenderContext::surface_features(const ScenePlan& part) const {
    return kilolux::surface_features(scene->scene(), part.gbuffer,
                                     chosen_anisotropy(settings, gpu.info));
}

SurfaceScene& RenderContext::device_surfaces() {
    if (!surfaces) {
        surfaces = std::make_shared<SurfaceScene>(gpu, tuning, scene->scene(),
                                                  surface_features(plan.of_layers()));
    }
    return *surfaces;
}

// A GPU's work-items resolve one pixel each: lanes of one work-item would wait for each other.
Gpu RenderContext::resolving_gpu() const { return gpu.info.is_cpu ? gpu : gpu.with_lanes(1); }

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

bool draws_in_opencl(const RenderScene& scene, const RenderSettings& settings,
                     const Tuning& tuning) {
    return resolves_ids(settings.geometry) && !is_forward(settings.renderer) &&
           chooses_compute(scene, settings, tuning);
}

RenderContext make_context(std::shared_ptr<RenderScene> scene, const RenderSettings& settings,
                           const Gpu& opened) {
    const ScenePlan plan = plan_of(scene->scene(), settings);
    Gpu gpu = opened;
    Tuning tuning = choose_tuning(describe(gpu.device), settings.kernels).tuning;
    // Two pixels of lights with a size need more registers than a GPU's work-item has (NVIDIA H100,
    // 1024 rectangles: shade takes 15.2 ms, and 5.2 with one lane).
    const bool is_narrow = plan.kernels.area_lights && !gpu.info.is_cpu;
    if (is_narrow && settings.kernels.lanes == 0) {
        gpu.info.lane_width = 1;
        tuning = with_device_lanes(tuning);
    }
    const bool in_opencl = draws_in_opencl(*scene, settings, tuning);
    if (in_opencl) note_limit(*scene, settings, tuning);
    const MemoryPlan memory = plan_memory(scene->scene(), settings, plan, gpu.info, in_opencl);
    gpu.budget = std::make_shared<MemoryBudget>(MemoryBudget{memory.device_bytes, 0});
    return {std::move(scene), settings, plan, gpu, tuning, memory, in_opencl};
}

}  // namespace kilolux
