// SPDX-License-Identifier: Apache-2.0
// What a Renderer is made of; between renderer.cpp, the flow, and renderer_change.cpp, which
// builds.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "host/picture/bands.h"
#include "host/picture/radiance_sum.h"
#include "host/render/deferred_path.h"
#include "host/render/forward_path.h"
#include "host/render/light_source.h"
#include "host/render/memory_plan.h"
#include "host/render/render_scene.h"
#include "host/render/renderer.h"
#include "host/stages/bloom.h"
#include "host/stages/tonemap.h"
#include "raster/overdraw_pass.h"

namespace kilolux {

struct Renderer::Parts {
    Parts(std::shared_ptr<RenderScene> the_scene, const RenderSettings& the_settings);
    ~Parts();
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;
    bool is_built_for(const RenderSettings& other) const;
    void take(const RenderSettings& next);
    static void change(std::unique_ptr<Parts>& parts, const std::shared_ptr<RenderScene>& scene,
                       const RenderSettings& settings);

    Frame render(const Camera& camera, double time, const std::function<void()>& between);
    Frame render_to(std::span<uint> pixels, const Camera& camera, double time);
    PixelProbe probe(int x, int y);
    void require_whole(const char* what) const;
    Radiance light(const SampleInput& sample, FrameStats& stats);
    Radiance light_samples(const SampleInput& band, FrameStats& stats);
    LightInput begin(const Camera& camera, double time, Frame& frame);
    void render_band(const SampleInput& band, Frame& frame, DecodedSurfaces& surfaces);
    void add_light(const Radiance& radiance, Frame& frame);
    void add_display(const Radiance& glowing, Frame& frame);
    void add_surfaces(const SampleInput& band, Frame& frame, DecodedSurfaces& surfaces);
    void take_stage_times(FrameStats& stats);
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
    }
    bool is_whole() const { return make_bands(settings.height, memory.band_rows).size() == 1; }
    Radiance glowing(const Radiance& radiance);
    void bloom_whole(const View& view, Frame& frame);
    void show_view(const Camera& camera, double time, const DecodedSurfaces& surfaces,
                   Frame& frame);
    void develop_to(std::span<uint> pixels, const Radiance& radiance);
    void make_optional_parts();

    std::shared_ptr<RenderScene> scene;  // first: the last to go
    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
    MemoryPlan memory;
    Tuning tuning;
    LightSource lights;
    RenderContext context;
    std::map<RendererKind, DeferredPath> deferred;  // made when first asked for
    std::map<RendererKind, ForwardPath> forward;
    std::unique_ptr<Parts> reference;      // for the view of differences from it
    std::optional<OverdrawPass> overdraw;  // for its view
    RadianceSum sum;
    std::optional<Bloom> bloom;  // none at a share of 0
    Tonemap tonemap;
    StageTimer timer;
    // Of the last render.
    LightRows rows;
    Camera last_camera;
};

}  // namespace kilolux
