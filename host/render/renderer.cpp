// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "host/base/log.h"
#include "host/interop/gbuffer_bridge.h"
#include "host/render/frame_parts.h"
#include "host/render/grid_request.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_input.h"
#include "host/render/light_lists.h"
#include "host/scene/light_ranges.h"
#include "host/stages/count_lights.h"
#include "host/stages/decode_gbuffer.h"
#include "host/stages/shade.h"
#include "host/stages/tonemap.h"
#include "raster/geometry_pass.h"
#include "raster/gl_context.h"
#include "raster/gpu_scene.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

std::vector<SceneLight> lights_with_ranges(const Scene& scene) {
    std::vector<SceneLight> lights = scene.lights;
    if (const std::size_t filled = fill_missing_ranges(lights); filled > 0) {
        note(scene.name + ": " + std::to_string(filled) + " lights without a range got one from their intensity, error at most " +
             std::to_string(kDefaultRangeBudget) + " each");
    }
    return lights;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

struct Renderer::Parts {
    Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl);
    Frame render_sample(const Camera& camera, double time, bool last);
    LightInput upload_lights(const LightRows& rows);
    Radiance light(const GBuffer& gbuffer, const Camera& camera, const LightInput& input, FrameStats& stats);
    void count(const GBuffer& gbuffer, const LightLists& lists, FrameStats& stats);
    void add_aovs(const GBuffer& gbuffer, const Camera& camera, Frame& frame);

    const Scene& scene;
    RenderSettings settings;
    Box box;
    std::vector<SceneLight> scene_lights;
    ScenePlan plan;
    Gpu gpu;
    Tuning tuning;
    std::optional<GlContext> context;
    GpuScene gpu_scene;
    GeometryPass geometry;
    GBufferBridge bridge;
    GrowingBuffer light_buffer, directional_buffer;
    ListStages list_stages;
    Shade shade;
    Tonemap tonemap;
    CountLights count_lights;
    DecodeGBuffer decode;
    std::optional<LightCounts> light_counts;
    ClusterGrid grid{};  // of the last frame
    StageTimer timer;
};

namespace {

std::optional<GlContext> context_from(GlSource gl) {
    if (gl == GlSource::current) return std::nullopt;
    return GlContext::headless();
}

std::uint64_t most_lights(const RenderSettings& settings, const Scene& scene) { return settings.lights.count + scene.lights.size(); }

}  // namespace

Renderer::Parts::Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl)
    : scene(the_scene), settings(the_settings), box(bounds(the_scene)), scene_lights(lights_with_ranges(the_scene)),
      plan(make_scene_plan(the_scene, the_settings, most_lights(the_settings, the_scene))),
      gpu(open_device(the_settings)), tuning(choose_tuning(describe(gpu.device), the_settings.kernels).tuning),
      context(context_from(gl)), gpu_scene(the_scene), geometry(gpu_scene, plan.gbuffer), bridge(gpu),
      light_buffer(gpu, "lights"), directional_buffer(gpu, "lights"), list_stages(gpu, tuning, plan.kernels),
      shade(gpu, tuning, plan.kernels), tonemap(gpu, tuning, static_cast<int>(the_settings.tone_curve)),
      count_lights(gpu, tuning, plan.kernels), decode(gpu, tuning, plan.kernels) {
    shade.set_ambient(settings.ambient);
}

LightInput Renderer::Parts::upload_lights(const LightRows& rows) {
    LightInput input;
    input.count = static_cast<uint>(rows.local.size());
    input.directional_count = static_cast<uint>(rows.directional.size());
    input.lights = light_buffer.reserve(rows.local.size() * sizeof(Light));
    input.directional = directional_buffer.reserve(rows.directional.size() * sizeof(DirectionalLight));
    upload<Light>(gpu, input.lights, rows.local);
    upload<DirectionalLight>(gpu, input.directional, rows.directional);
    return input;
}

// From the G-buffer and the lights to radiance.
Radiance Renderer::Parts::light(const GBuffer& gbuffer, const Camera& camera, const LightInput& input, FrameStats& stats) {
    const GridRequest request = grid_request(settings.grid, camera, box, position_pad(settings.gbuffer, box, camera));
    grid = make_cluster_grid(request, gbuffer.view.width, gbuffer.view.height);
    stats.grid[0] = grid.tiles_x;
    stats.grid[1] = grid.tiles_y;
    stats.grid[2] = grid.slices;
    LightLists lists = list_stages.enqueue(input, gbuffer, grid, timer);
    if (settings.renderer == RendererKind::deferred_all) return shade.enqueue_all_lights(gbuffer, lists.lights, timer);
    Radiance radiance = shade.enqueue(gbuffer, lists.lights, grid, lists.clusters, lists.refined, timer);
    // Room for the lists is last frame's: where that was too little, grow it and do this frame again.
    while (!list_stages.fit()) {
        timer.take();
        lists = list_stages.enqueue(input, gbuffer, grid, timer);
        radiance = shade.enqueue(gbuffer, lists.lights, grid, lists.clusters, lists.refined, timer);
    }
    count(gbuffer, lists, stats);
    return radiance;
}

void Renderer::Parts::count(const GBuffer& gbuffer, const LightLists& lists, FrameStats& stats) {
    list_stages.count(lists, stats);
    stats.useful_evaluations_per_pixel = -1.0;
    if (!settings.count_useful) return;
    StageTimer untimed;
    light_counts = count_lights.enqueue(gbuffer, lists.lights, lists.boxes.grid, lists.clusters, lists.refined, untimed);
    const auto covering = download<uint>(gpu, light_counts->covering, std::size_t{gbuffer.view.stride} * gbuffer.view.height);
    stats.useful_evaluations_per_pixel = mean_of_drawn(covering);
}

void Renderer::Parts::add_aovs(const GBuffer& gbuffer, const Camera& camera, Frame& frame) {
    if (settings.aovs.empty()) return;
    StageTimer untimed;
    const View& view = gbuffer.view;
    DecodedSurfaces surfaces;
    surfaces.view = view;
    surfaces.grid = grid;
    surfaces.planes = download<float>(gpu, decode.enqueue(gbuffer, untimed), std::size_t{SURFACE_PLANES} * view.stride * view.height);
    if (light_counts) {
        surfaces.evaluated = download<uint>(gpu, light_counts->evaluated, std::size_t{view.stride} * view.height);
    }
    for (const std::string& name : settings.aovs) frame.aovs.push_back(make_aov(name, surfaces, camera));
}

Frame Renderer::Parts::render_sample(const Camera& camera, double time, bool last) {
    if (context) context->make_current();
    const Clock::time_point start = Clock::now();
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    std::vector<SceneLight> lights = scene_lights;
    const std::vector<SceneLight> generated = generate_lights(settings.lights, scene, time);
    lights.insert(lights.end(), generated.begin(), generated.end());
    const LightRows rows = make_light_rows(lights, camera.position);
    frame.stats.lights_given = lights.size();
    frame.stats.lights_rejected = rows.rejected;
    frame.stats.lights_used = rows.local.size() + rows.directional.size();
    frame.stats.directional_lights = rows.directional.size();
    frame.stats.lights_dropped = lights.size() - rows.rejected - frame.stats.lights_used;
    const double lights_ms = ms_since(start);

    const LightInput input = upload_lights(rows);
    geometry.draw(camera, settings.width, settings.height);
    const GBuffer gbuffer = bridge.transfer(geometry.targets(), plan.gbuffer, view_of(camera, settings.width, settings.height));
    const Radiance radiance = light(gbuffer, camera, input, frame.stats);
    const cl::Buffer display = tonemap.enqueue(radiance, settings.exposure, timer);
    frame.radiance = tight_radiance(download<float>(gpu, radiance.planes, std::size_t{3} * gbuffer.view.stride * gbuffer.view.height), gbuffer.view);
    frame.display = tight_display(download<uint>(gpu, display, std::size_t{gbuffer.view.stride} * gbuffer.view.height), gbuffer.view);
    frame.stats.frame_ms = ms_since(start);

    frame.stats.stages = {{"light_input", lights_ms, 0.0}, {"geometry", geometry.last_ms(), 0.0}, {"gbuffer_bridge", bridge.last_ms(), 0.0}};
    for (const StageTimer::Time& stage : timer.take()) frame.stats.stages.push_back({stage.stage, stage.ms, 0.0});
    if (last) add_aovs(gbuffer, camera, frame);
    return frame;
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : parts_(std::make_unique<Parts>(scene, settings, gl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Frame Renderer::render(const Camera& camera, double time) {
    return in_stage("render", [&] { return parts_->render_sample(camera, time, true); });
}

const DeviceInfo& Renderer::device() const { return parts_->gpu.info; }
const ScenePlan& Renderer::plan() const { return parts_->plan; }

}  // namespace kilolux
