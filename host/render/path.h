// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "host/gpu/features.h"
#include "host/gpu/flow.h"
#include "host/lighting/deferred_lighting.h"
#include "host/picture/bands.h"
#include "host/picture/frame.h"
#include "host/render/light_rows.h"
#include "host/render/render_scene.h"
#include "host/render/scene_plan.h"
#include "host/render/settings.h"
#include "host/scene/open_tiles.h"
#include "host/stages/shading/fill_background.h"
#include "host/stages/shading/reflect_environment.h"
#include "host/surfaces/shadow_scene.h"
#include "host/surfaces/surface_scene.h"

namespace kilolux {

/// What the way from surfaces to radiance is made for; outlives it.
struct PathContext {
    const RenderSettings& settings;
    const ScenePlan& plan;
    const Gpu& gpu;
    const Tuning& tuning;
    const RenderScene& scene;
    std::shared_ptr<SurfaceScene>& surfaces;  // the scene on the device, made when first asked for
    std::shared_ptr<ShadowScene>& shadows;    // what of it casts shadows, likewise
    // Made where settings.background and settings.reflections are set.
    std::optional<FillBackground>* background = nullptr;
    std::optional<ReflectEnvironment>* reflections = nullptr;

    /// What a path's lighting enqueues after it: what the environment adds, and `then`.
    AfterShading with_environment(const GBuffer& gbuffer, StageTimer& timer,
                                  const AfterShading& then) const {
        if (!settings.background && !settings.reflections) return then;
        return [&, then](const Radiance& radiance) {
            if (settings.reflections) (*reflections)->enqueue(gbuffer, radiance, timer);
            if (settings.background) (*background)->enqueue(gbuffer, radiance, timer);
            if (then) then(radiance);
        };
    }

    /// Whether shading makes the display picture itself: where nothing else reads or changes the
    /// light after it, and its kernels' arithmetic is that of tone mapping.
    bool shades_display() const;

    /// Whether OpenCL makes the surfaces of OpenGL's ids: not for what OpenGL's fragments light.
    bool resolves() const {
        return resolves_ids(settings.geometry) && !is_forward(settings.renderer);
    }
    bool chooses_compute() const {
        if (settings.geometry != Geometry::automatic) return settings.geometry == Geometry::compute;
        return tuning.geometry == 1 || !scene.has_opengl();
    }
    /// Whether OpenCL draws the triangles, too: not where OpenGL blends surfaces over them.
    bool draws_in_opencl() const {
        return chooses_compute() && resolves() && !has_blended_surfaces(scene.scene());
    }
    /// The scene as this way's OpenGL passes need it.
    const GpuScene& meshes() const {
        return scene.meshes(resolves() ? GpuSceneUse::covered : GpuSceneUse::shaded,
                            settings.anisotropy);
    }
};

/// The fine tiles of a band that need a sample; the others' pixels may be background.
struct NeededTiles {
    TileCounts done;
    OpenTiles open;
};

/// One sample of a band of a frame to light: the lights on the host and, uploaded, on the device.
struct Sample {
    const Camera& camera;  // of the whole picture
    const LightRows& rows;
    LightInput lights;
    Band band;
    bool redraw = true;  // else OpenGL's targets still hold this sample of the band's raster tile
    uint number = 0;     // of the pixel's samples
    const NeededTiles* needed = nullptr;        // none: all of the band
    std::optional<DisplayTarget> display = {};  // see LightingInput
};

/// What a path adds to while it lights a sample.
struct Measured {
    StageTimer& timer;  // the device's stages
    FrameStats& stats;  // counts, and the host's stages
};

/// Adds a stage that the host or OpenGL has just ended.
inline void add_host_time(Measured out, std::string_view stage, double ms) {
    out.timer.record_host(ms);
    add_stage_time(out.stats.stages, stage, ms);
}

}  // namespace kilolux
