// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/lighting_bench.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>

#include "host/interop/gbuffer_bridge.h"
#include "host/lighting/deferred_lighting.h"
#include "host/render/grid_request.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_rows.h"
#include "host/render/light_source.h"
#include "host/stages/tonemap.h"
#include "raster/geometry_pass.h"
#include "raster/gl_context.h"
#include "raster/gpu_scene.h"

namespace kilolux {
namespace {

// FNV-1a over 32-bit words.
std::uint64_t hash_words(std::span<const uint> words) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const uint word : words) hash = (hash ^ word) * 0x100000001b3u;
    return hash;
}

bool same_planes(const GBufferNeeds& a, const GBufferNeeds& b) {
    return a.layout == b.layout && a.material == b.material && a.occlusion == b.occlusion &&
           a.emissive_scale == b.emissive_scale && a.specular == b.specular && a.unlit == b.unlit;
}

// The least time of each stage so far.
void keep_least(std::vector<StageTime>& least, const std::string& stage, double ms) {
    const auto found = std::find_if(least.begin(), least.end(),
                                    [&](const StageTime& s) { return s.name == stage; });
    if (found == least.end()) {
        least.push_back({stage, ms, 0.0});
    } else {
        found->ms = std::min(found->ms, ms);
    }
}

// The stages after the G-buffer.
struct Stages {
    Stages(const Gpu& gpu, const LightingRequest& request, const RenderSettings& settings)
        : lighting(gpu, request.tuning.tuning, request.plan.kernels),
          tonemap(gpu, request.tuning.tuning, static_cast<int>(settings.tone_curve)) {
        lighting.set_ambient(settings.ambient);
    }
    DeferredLighting lighting;
    Tonemap tonemap;
};

}  // namespace

struct LightingBench::Parts {
    Parts(const Scene& the_scene, const RenderSettings& the_settings, const Camera& the_camera,
          double time);
    void load_lights(double time);
    void set_layout(const GBufferNeeds& needs);
    void draw(std::vector<StageTime>* least);
    Radiance light(Stages& stages);
    LightingRun run(const LightingRequest& request);

    const Scene& scene;
    RenderSettings settings;
    Camera camera;
    Box box;
    ScenePlan plan;
    Gpu gpu;
    DeviceInfo device;
    GlContext context;
    GpuScene gpu_scene;
    std::optional<GeometryPass> geometry;
    GBufferBridge bridge;
    GBuffer gbuffer;
    LightInput lights;
    FrameStats light_stats;
    StageTimer timer;
};

LightingBench::Parts::Parts(const Scene& the_scene, const RenderSettings& the_settings,
                            const Camera& the_camera, double time)
    : scene(the_scene),
      settings(the_settings),
      camera(the_camera),
      box(bounds(the_scene)),
      plan(make_scene_plan(the_scene, the_settings,
                           the_settings.lights.count + the_scene.lights.size())),
      gpu(open_device(the_settings)),
      device(describe(gpu.device)),
      context(GlContext::headless()),
      gpu_scene(the_scene),
      bridge(gpu) {
    load_lights(time);
}

void LightingBench::Parts::load_lights(double time) {
    const std::vector<SceneLight> all = lights_at(scene, settings, time);
    const LightRows rows = make_light_rows(all, camera.position);
    light_stats.lights_given = all.size();
    light_stats.lights_rejected = rows.rejected;
    light_stats.lights_used = rows.local.size() + rows.directional.size();
    light_stats.directional_lights = rows.directional.size();
    lights.count = static_cast<uint>(rows.local.size());
    lights.directional_count = static_cast<uint>(rows.directional.size());
    lights.lights = GrowingBuffer(gpu, "lights").reserve(rows.local.size() * sizeof(Light));
    lights.directional =
        GrowingBuffer(gpu, "lights").reserve(rows.directional.size() * sizeof(DirectionalLight));
    upload<Light>(gpu, lights.lights, rows.local);
    upload<DirectionalLight>(gpu, lights.directional, rows.directional);
}

void LightingBench::Parts::set_layout(const GBufferNeeds& needs) {
    if (geometry && same_planes(geometry->needs(), needs)) return;
    geometry.emplace(gpu_scene, needs);
    draw(nullptr);
}

void LightingBench::Parts::draw(std::vector<StageTime>* least) {
    using Clock = std::chrono::steady_clock;
    gpu.queue.finish();
    const Clock::time_point start = Clock::now();
    geometry->draw(camera, settings.width, settings.height);
    const std::chrono::duration<double, std::milli> drawing = Clock::now() - start;
    gbuffer = bridge.transfer(geometry->targets(), geometry->needs(),
                              view_of(camera, settings.width, settings.height));
    if (!least) return;
    // The transfer waits for OpenGL, whatever part of the drawing it did not do at once.
    keep_least(*least, "geometry", drawing.count());
    keep_least(*least, "gbuffer_bridge", bridge.last_ms());
}

Radiance LightingBench::Parts::light(Stages& stages) {
    const GridRequest request = grid_request(settings.grid, camera, box,
                                             position_pad(geometry->needs().layout, box, camera));
    const ClusterGrid grid = make_cluster_grid(request, gbuffer.view.width, gbuffer.view.height);
    return stages.lighting.light({gbuffer, lights, grid}, timer, [&](const Radiance& radiance) {
        stages.tonemap.enqueue(radiance, settings.exposure, timer);
    });
}

LightingRun LightingBench::Parts::run(const LightingRequest& request) {
    context.make_current();
    set_layout(request.plan.gbuffer);
    const Gpu lanes_gpu = gpu.with_lanes(request.tuning.lanes);
    Stages stages(lanes_gpu, request, settings);
    LightingRun out;
    out.stats = light_stats;
    Radiance radiance = light(stages);
    timer.take();
    static_cast<PairCounts&>(out.stats) = stages.lighting.light_lists().counts();
    out.stats.evaluations_per_pixel = mean_list_length(out.stats);
    const ClusterGrid& grid = stages.lighting.lists().grid;
    std::ranges::copy(std::array{grid.tiles_x, grid.tiles_y, grid.slices}, out.stats.grid);
    out.stats.useful_evaluations_per_pixel = -1.0;
    for (int i = 0; i < std::max(request.runs, 1); ++i) {
        if (request.geometry) draw(&out.stats.stages);
        radiance = light(stages);
        for (const StageTimer::Time& stage : timer.take())
            keep_least(out.stats.stages, stage.stage, stage.ms);
    }
    for (const StageTime& stage : out.stats.stages) out.ms += stage.ms;
    const std::size_t words = std::size_t{3} * gbuffer.view.stride * gbuffer.view.height;
    out.picture = hash_words(download<uint>(gpu, radiance.planes, words));
    return out;
}

LightingBench::LightingBench(const Scene& scene, const RenderSettings& settings,
                             const Camera& camera, double time)
    : parts_(in_stage("lighting bench",
                      [&] { return std::make_unique<Parts>(scene, settings, camera, time); })) {}
LightingBench::~LightingBench() = default;
LightingBench::LightingBench(LightingBench&&) noexcept = default;
LightingBench& LightingBench::operator=(LightingBench&&) noexcept = default;

LightingRun LightingBench::run(const LightingRequest& request) {
    return in_stage("lighting bench", [&] { return parts_->run(request); });
}

LightingRequest LightingBench::request() const {
    return {parts_->plan, choose_tuning(parts_->device, parts_->settings.kernels)};
}

const DeviceInfo& LightingBench::device() const { return parts_->device; }
const Scene& LightingBench::scene() const { return parts_->scene; }
const RenderSettings& LightingBench::settings() const { return parts_->settings; }

}  // namespace kilolux
