// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <chrono>
#include <optional>

#include "host/render/deferred_path.h"
#include "host/render/forward_path.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_source.h"
#include "host/stages/tonemap.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::optional<GlContext> context_from(GlSource gl) {
    if (gl == GlSource::current) return std::nullopt;
    return GlContext::headless();
}

bool is_forward(RendererKind renderer) {
    return renderer == RendererKind::forward || renderer == RendererKind::forward_plus;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

struct Renderer::Parts {
    Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl);
    Frame render(const Camera& camera, double time);
    Radiance light(const Camera& camera, const LightRows& rows, FrameStats& stats);
    void add_pixels(const Camera& camera, Frame& frame);

    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
    Tuning tuning;
    std::optional<GlContext> gl_context;
    GpuScene gpu_scene;
    LightSource lights;
    RenderContext context;
    std::optional<DeferredPath> deferred;  // this,
    std::optional<ForwardPath> forward;    // or this
    Tonemap tonemap;
    StageTimer timer;
};

Renderer::Parts::Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl)
    : settings(the_settings),
      plan(make_scene_plan(the_scene, settings, settings.lights.count + the_scene.lights.size())),
      gpu(open_device(settings)),
      tuning(choose_tuning(describe(gpu.device), settings.kernels).tuning),
      gl_context(context_from(gl)),
      gpu_scene(the_scene),
      lights(gpu, the_scene, settings.lights),
      context{settings, plan, gpu, tuning, gpu_scene, bounds(the_scene)},
      tonemap(gpu, tuning, static_cast<int>(settings.tone_curve)) {
    if (is_forward(settings.renderer)) {
        forward.emplace(context);
    } else {
        deferred.emplace(context);
    }
}

// From the lights to a picture's radiance, by the path that was asked for.
Radiance Renderer::Parts::light(const Camera& camera, const LightRows& rows, FrameStats& stats) {
    const SampleInput sample{camera, rows, lights.upload(rows)};
    return deferred ? deferred->light(sample, timer, stats) : forward->light(sample, timer, stats);
}

void Renderer::Parts::add_pixels(const Camera& camera, Frame& frame) {
    if (!wants_pixels(settings)) return;
    const DecodedSurfaces pixels = deferred ? deferred->pixels() : forward->pixels(camera);
    for (const std::string& name : settings.aovs) {
        frame.aovs.push_back(make_aov(name, pixels, camera));
    }
}

Frame Renderer::Parts::render(const Camera& camera, double time) {
    if (gl_context) gl_context->make_current();
    const Clock::time_point start = Clock::now();
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    const LightRows rows = lights.at(time, camera.position, frame.stats);
    add_stage_time(frame.stats.stages, "light_input", ms_since(start));

    const Radiance radiance = light(camera, rows, frame.stats);
    const cl::Buffer display = tonemap.enqueue(radiance, settings.exposure, timer);

    const View& view = radiance.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    frame.radiance = tight_radiance(download<float>(gpu, radiance.planes, 3 * plane), view);
    frame.display = tight_display(download<uint>(gpu, display, plane), view);
    frame.stats.frame_ms = ms_since(start);
    for (const StageTimer::Time& stage : timer.take()) {
        add_stage_time(frame.stats.stages, stage.stage, stage.ms);
    }
    add_pixels(camera, frame);
    return frame;
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : parts_(std::make_unique<Parts>(scene, settings, gl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Frame Renderer::render(const Camera& camera, double time) {
    return in_stage("render", [&] { return parts_->render(camera, time); });
}

const DeviceInfo& Renderer::device() const {
    return parts_->gpu.info;
}
const ScenePlan& Renderer::plan() const {
    return parts_->plan;
}

}  // namespace kilolux
