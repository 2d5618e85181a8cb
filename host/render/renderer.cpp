// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <chrono>
#include <cstring>
#include <map>

#include "host/render/deferred_path.h"
#include "host/render/forward_path.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_source.h"
#include "host/render/radiance_sum.h"
#include "host/render/render_scene.h"
#include "host/render/sample_pattern.h"
#include "host/render/views.h"
#include "host/stages/bloom.h"
#include "host/stages/tonemap.h"
#include "raster/overdraw_pass.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

bool is_forward(RendererKind renderer) {
    return renderer == RendererKind::forward || renderer == RendererKind::forward_plus;
}

// The same picture with every light at every pixel.
RenderSettings reference_of(RenderSettings settings) {
    settings.renderer = RendererKind::deferred_all;
    settings.show = "lit";
    settings.aovs.clear();
    return settings;
}

ScenePlan plan_of(const Scene& scene, const RenderSettings& settings) {
    return make_scene_plan(scene, settings, settings.lights.count + scene.lights.size());
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

std::size_t display_stride(int width) {
    return view_of(Camera{}, width, 1).stride;
}

struct Renderer::Parts {
    Parts(const RenderScene& the_scene, const RenderSettings& the_settings);
    bool is_built_for(const RenderSettings& other) const;
    void take(const RenderSettings& next);
    static void change(std::unique_ptr<Parts>& parts, const RenderScene& scene,
                       const RenderSettings& settings);

    Frame render(const Camera& camera, double time);
    Frame render_to(std::span<uint> pixels, const Camera& camera, double time);
    Radiance light(const SampleInput& sample, FrameStats& stats);
    Radiance light_samples(const Camera& camera, FrameStats& stats);
    Radiance light_frame(const Camera& camera, double time, FrameStats& stats);
    DecodedSurfaces surfaces(const Camera& camera);
    PixelProbe probe(int x, int y);
    Radiance glowing(const Radiance& radiance);
    Frame empty_frame() const;
    void make_optional_parts();
    void take_stage_times(FrameStats& stats);
    void add_pixels(const Camera& camera, double time, Frame& frame);
    void develop_to(std::span<uint> pixels, const Radiance& radiance);

    const RenderScene& scene;
    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
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

Renderer::Parts::Parts(const RenderScene& the_scene, const RenderSettings& the_settings)
    : scene(the_scene),
      settings(the_settings),
      plan(plan_of(the_scene.scene, settings)),
      gpu(open_device(settings)),
      tuning(choose_tuning(describe(gpu.device), settings.kernels).tuning),
      lights(gpu, the_scene.scene, settings.lights),
      context{settings, plan, gpu, tuning, *the_scene.meshes, the_scene.box},
      sum(gpu),
      tonemap(gpu, tuning, static_cast<int>(settings.tone_curve)) {
    make_optional_parts();
}

// What some settings need and others do not.
void Renderer::Parts::make_optional_parts() {
    const RendererKind kind = settings.renderer;
    if (is_forward(kind)) {
        if (!forward.contains(kind)) forward.try_emplace(kind, context);
    } else if (!deferred.contains(kind)) {
        deferred.try_emplace(kind, context);
    }
    if (settings.bloom > 0.0f && !bloom) bloom.emplace(gpu);
    if (settings.show == "overdraw" && !overdraw) overdraw.emplace(*scene.meshes);
    if (settings.show == "difference") change(reference, scene, reference_of(settings));
}

// Whether other settings need neither other kernels nor another device.
bool Renderer::Parts::is_built_for(const RenderSettings& other) const {
    return other.device == settings.device && other.kernels == settings.kernels &&
           plan_of(scene.scene, other) == plan;
}

void Renderer::Parts::take(const RenderSettings& next) {
    const RenderSettings former = std::exchange(settings, next);
    try {
        make_optional_parts();
        if (next.tone_curve != former.tone_curve) {
            tonemap = Tonemap(gpu, tuning, static_cast<int>(next.tone_curve));
        }
    } catch (...) {
        settings = former;
        throw;
    }
    lights.set_generated(next.lights);
}

void Renderer::Parts::change(std::unique_ptr<Parts>& parts, const RenderScene& scene,
                             const RenderSettings& settings) {
    if (parts && parts->is_built_for(settings)) {
        parts->take(settings);
    } else {
        parts = std::make_unique<Parts>(scene, settings);
    }
}

// From the lights to a sample's radiance, by the path that was asked for.
Radiance Renderer::Parts::light(const SampleInput& sample, FrameStats& stats) {
    const RendererKind kind = settings.renderer;
    return is_forward(kind) ? forward.at(kind).light(sample, timer, stats)
                            : deferred.at(kind).light(sample, timer, stats);
}

// The mean of the jittered samples. Sample 0, through the pixels' centres, comes last: counts, AOVs
// and views are its, since depths, ids and unit vectors have no mean.
Radiance Renderer::Parts::light_samples(const Camera& camera, FrameStats& stats) {
    const LightInput input = lights.upload(rows);
    if (settings.samples <= 1) return light({camera, rows, input}, stats);
    sum.clear();
    for (int i = settings.samples - 1; i >= 0; --i) {
        Camera jittered = camera;
        jittered.jitter += sample_offset(static_cast<std::uint32_t>(i));
        sum.add(light({jittered, rows, input}, stats));
        take_stage_times(stats);
    }
    return sum.mean();
}

// Before the next sample, whose lists may have to be made again, and its time counted anew.
void Renderer::Parts::take_stage_times(FrameStats& stats) {
    for (const StageTimer::Time& stage : timer.take()) {
        add_stage_time(stats.stages, stage.stage, stage.ms);
    }
}

DecodedSurfaces Renderer::Parts::surfaces(const Camera& camera) {
    const RendererKind kind = settings.renderer;
    return is_forward(kind) ? forward.at(kind).pixels(camera) : deferred.at(kind).pixels();
}

// AOVs, and the view in place of the lit picture.
void Renderer::Parts::add_pixels(const Camera& camera, double time, Frame& frame) {
    if (!wants_pixels(settings)) return;
    const DecodedSurfaces pixels = surfaces(camera);
    for (const std::string& name : settings.aovs) {
        frame.aovs.push_back(make_aov(name, pixels, camera));
    }
    if (settings.show == "lit") return;
    std::vector<float> fragments, reference_radiance;
    if (settings.show == "overdraw") {
        fragments = overdraw->count(camera, settings.width, settings.height);
    }
    if (settings.show == "difference") {
        reference_radiance = reference->render(camera, time).radiance;
    }
    frame.display = make_view(settings.show, {pixels, camera, context.box, fragments,
                                              frame.radiance, reference_radiance});
}

// From the lights to a frame's radiance.
Radiance Renderer::Parts::light_frame(const Camera& camera, double time, FrameStats& stats) {
    if (scene.context) scene.context->make_current();
    const Clock::time_point start = Clock::now();
    last_camera = camera;
    rows = lights.at(time, camera.position, stats);
    add_stage_time(stats.stages, "light_input", ms_since(start));
    return light_samples(camera, stats);
}

Radiance Renderer::Parts::glowing(const Radiance& radiance) {
    return settings.bloom > 0.0f ? bloom->enqueue(radiance, settings.bloom, timer) : radiance;
}

Frame Renderer::Parts::empty_frame() const {
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    return frame;
}

Frame Renderer::Parts::render(const Camera& camera, double time) {
    const Clock::time_point start = Clock::now();
    Frame frame = empty_frame();
    const Radiance radiance = light_frame(camera, time, frame.stats);
    const cl::Buffer display = tonemap.enqueue(glowing(radiance), settings.exposure, timer);

    const View& view = radiance.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    frame.radiance = tight_radiance(download<float>(gpu, radiance.planes, 3 * plane), view);
    frame.display = tight_display(download<uint>(gpu, display, plane), view);
    frame.stats.frame_ms = ms_since(start);
    take_stage_times(frame.stats);
    add_pixels(camera, time, frame);
    return frame;
}

// The display picture to the caller's memory: a CPU device's kernel writes there itself.
void Renderer::Parts::develop_to(std::span<uint> pixels, const Radiance& radiance) {
    const Radiance shown = glowing(radiance);
    if (!gpu.info.is_cpu) {
        const cl::Buffer display = tonemap.enqueue(shown, settings.exposure, timer);
        gpu.queue.enqueueReadBuffer(display, CL_TRUE, 0, pixels.size_bytes(), pixels.data());
        return;
    }
    const cl::Buffer display(gpu.context, CL_MEM_WRITE_ONLY | CL_MEM_USE_HOST_PTR,
                             pixels.size_bytes(), pixels.data());
    tonemap.enqueue_to(display, shown, settings.exposure, timer);
    void* mapped =
        gpu.queue.enqueueMapBuffer(display, CL_TRUE, CL_MAP_READ, 0, pixels.size_bytes());
    gpu.queue.enqueueUnmapMemObject(display, mapped);
    gpu.queue.finish();
}

Frame Renderer::Parts::render_to(std::span<uint> pixels, const Camera& camera, double time) {
    const std::size_t stride = display_stride(settings.width);
    pixels = pixels.first(stride * static_cast<std::size_t>(settings.height));
    if (settings.show != "lit") {
        Frame frame = render(camera, time);
        const auto row = static_cast<std::size_t>(settings.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(settings.height); ++y) {
            std::memcpy(&pixels[y * stride], &frame.display[4 * y * row], 4 * row);
        }
        frame.display.clear();
        frame.radiance.clear();
        return frame;
    }
    const Clock::time_point start = Clock::now();
    Frame frame = empty_frame();
    const Radiance radiance = light_frame(camera, time, frame.stats);
    develop_to(pixels, radiance);
    frame.stats.frame_ms = ms_since(start);
    take_stage_times(frame.stats);
    add_pixels(camera, time, frame);
    return frame;
}

PixelProbe Renderer::Parts::probe(int x, int y) {
    PixelProbe out = is_forward(settings.renderer)
                         ? forward.at(settings.renderer).probe(last_camera, x, y)
                         : deferred.at(settings.renderer).probe(x, y);
    const View view = view_of(last_camera, settings.width, settings.height);
    for (ProbedLight& light : out.lights) {
        light.light = rows.local.at(light.index);
        light.shade = shade_light(view, light.light);
    }
    return out;
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : scene_(std::make_shared<RenderScene>(scene, gl == GlSource::headless)),
      parts_(std::make_unique<Parts>(*scene_, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::change(const RenderSettings& settings) {
    if (settings == parts_->settings) return;
    if (scene_->context) scene_->context->make_current();
    in_stage("settings", [&] { Parts::change(parts_, *scene_, settings); });
}

const RenderSettings& Renderer::settings() const {
    return parts_->settings;
}

Frame Renderer::render(const Camera& camera, double time) {
    return in_stage("render", [&] { return parts_->render(camera, time); });
}

Frame Renderer::render_to(std::span<uint> pixels, const Camera& camera, double time) {
    return in_stage("render", [&] { return parts_->render_to(pixels, camera, time); });
}

LitSurfaces Renderer::lit_surfaces() {
    const auto found = parts_->deferred.find(parts_->settings.renderer);
    if (found == parts_->deferred.end()) {
        throw Error("renderer: the forward renderers keep no G-buffer to look at");
    }
    return in_stage("lit surfaces", [&] { return found->second.lit_surfaces(); });
}

std::uint64_t Renderer::light_count(const RenderSettings& settings) const {
    return settings.lights.count + scene_->scene.lights.size();
}

PixelProbe Renderer::probe(int x, int y) {
    if (scene_->context) scene_->context->make_current();
    return in_stage("probe", [&] { return parts_->probe(x, y); });
}

std::vector<ActiveCluster> Renderer::active_clusters() const {
    const auto found = parts_->deferred.find(RendererKind::deferred);
    if (parts_->settings.renderer != RendererKind::deferred || found == parts_->deferred.end()) {
        return {};
    }
    return in_stage("active clusters", [&] { return found->second.active_clusters(); });
}

const DeviceInfo& Renderer::device() const {
    return parts_->gpu.info;
}
const ScenePlan& Renderer::plan() const {
    return parts_->plan;
}
const Gpu& Renderer::gpu() const {
    return parts_->gpu;
}

}  // namespace kilolux
