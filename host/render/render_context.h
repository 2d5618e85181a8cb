// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/gpu/features.h"
#include "host/render/plan/memory_plan.h"
#include "host/render/plan/scene_plan.h"
#include "host/render/render_scene.h"
#include "host/render/settings.h"
#include "host/surfaces/shadow_scene.h"
#include "host/surfaces/surface_scene.h"

namespace kilolux {

/// The scene, settings and device that a renderer is made for: its parts refer to it, and it
/// outlives them.
struct RenderContext {
    std::shared_ptr<RenderScene> scene;  // first member: destroyed last
    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
    Tuning tuning;
    MemoryPlan memory;
    bool draws_in_opencl = false;  // see kilolux::draws_in_opencl()
    // Made when first asked for: the scene on the device, and its shadow casters.
    std::shared_ptr<SurfaceScene> surfaces{};
    std::shared_ptr<ShadowScene> shadows{};

    /// Whether shading makes the display picture itself: where no later stage reads or changes the
    /// light, and the kernels' arithmetic is that of tone mapping.
    bool shades_display() const;

    /// Whether OpenCL resolves OpenGL's ids: not where OpenGL's fragments are lit.
    bool resolves() const {
        return resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    }
    /// Whether some surfaces blend over others.
    bool blends() const {
        return !plan.kernels.illuminance && has_blended_surfaces(scene->scene());
    }

    /// Whether OpenGL's fragments are lit, from lights on the host.
    bool lights_on_host() const { return is_forward(settings.renderer); }

    /// Whether the picture is made in one band.
    bool is_whole() const;

    /// The scene's meshes for the OpenGL passes of this renderer.
    const GpuScene& meshes() const;

    /// The coarse grid of a frame.
    ClusterGrid coarse_grid(const Camera& camera) const;

    /// The scene's surfaces on the device.
    SurfaceScene& device_surfaces();

    /// The device with the lanes of kernels that resolve triangles.
    Gpu resolving_gpu() const;

    /// The features that resolve_surfaces and shadow casters read of the scene's materials, for
    /// opaque surfaces and for a part of the plan.
    SurfaceFeatures surface_features() const { return surface_features(plan); }
    SurfaceFeatures surface_features(const ScenePlan& part) const;
};

/// The plan for a scene with its own lights and the generated ones.
ScenePlan plan_of(const Scene& scene, const RenderSettings& settings);

/// Whether OpenCL draws the triangles, too: not where OpenGL lights surfaces. Automatic
/// geometry takes what the tuning says is faster, or OpenCL where OpenGL lacks or cannot draw
/// pictures of that width.
bool draws_in_opencl(const RenderScene& scene, const RenderSettings& settings,
                     const Tuning& tuning);

/// Throws Error as Renderer does, before anything large is uploaded where the pictures cannot fit.
/// All buffers made with its Gpu are held within the memory plan.
RenderContext make_context(std::shared_ptr<RenderScene> scene, const RenderSettings& settings,
                           const Gpu& opened);

}  // namespace kilolux
