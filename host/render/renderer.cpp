// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <chrono>
#include <optional>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/render/deferred_path.h"
#include "host/render/forward_path.h"
#include "host/render/frame_bands.h"
#include "host/render/kernel_choice.h"
#include "host/render/light_source.h"
#include "host/render/memory_plan.h"
#include "host/render/radiance_sum.h"
#include "host/render/sample_pattern.h"
#include "host/render/views.h"
#include "host/stages/bloom.h"
#include "host/stages/tonemap.h"
#include "raster/gl_context.h"
#include "raster/overdraw_pass.h"

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

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

struct Renderer::Parts {
    Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl);
    ~Parts();
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;
    Frame render(const Camera& camera, double time, const std::function<void()>& between);
    void take_up_changes();
    Radiance light(const SampleInput& sample, FrameStats& stats);
    Radiance light_samples(const SampleInput& band, FrameStats& stats);
    void render_band(const SampleInput& band, Frame& frame, DecodedSurfaces& surfaces);
    void add_light(const Radiance& radiance, Frame& frame);
    void add_display(const Radiance& glowing, Frame& frame);
    void take_stage_times(FrameStats& stats);
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
    }
    void bloom_whole(const View& view, Frame& frame);
    void show_view(const Camera& camera, double time, const DecodedSurfaces& surfaces,
                   Frame& frame);

    const Scene& scene;
    std::uint32_t revision;  // of the scene that was taken up
    Box box;                 // of the scene then
    RenderSettings settings;
    ScenePlan plan;
    Gpu gpu;
    MemoryPlan memory;
    Tuning tuning;
    std::optional<GlContext> gl_context;
    GpuScene gpu_scene;
    LightSource lights;
    RenderContext context;
    std::optional<DeferredPath> deferred;  // this,
    std::optional<ForwardPath> forward;    // or this
    std::unique_ptr<Renderer> reference;   // for the view of differences from it
    std::optional<OverdrawPass> overdraw;  // for its view
    std::size_t zero_normals;
    RadianceSum sum;
    std::optional<Bloom> bloom;  // none at a share of 0
    Tonemap tonemap;
    StageTimer timer;
};

Renderer::Parts::Parts(const Scene& the_scene, const RenderSettings& the_settings, GlSource gl)
    : scene(the_scene),
      revision(the_scene.revision),
      box(bounds(the_scene)),
      settings(the_settings),
      plan(make_scene_plan(the_scene, settings, settings.lights.count + the_scene.lights.size())),
      gpu(open_device(settings)),
      memory(limit_buffers(gpu, plan_memory(the_scene, settings, plan, gpu.info))),
      tuning(choose_tuning(describe(gpu.device), settings.kernels).tuning),
      gl_context(context_from(gl)),
      gpu_scene(the_scene),
      lights(gpu, the_scene, settings),
      context{settings, plan, gpu, tuning, gpu_scene, box},
      zero_normals(zero_normal_count(the_scene)),
      sum(gpu),
      tonemap(gpu, tuning, static_cast<int>(settings.tone_curve)) {
    if (is_forward(settings.renderer)) {
        forward.emplace(context);
    } else {
        deferred.emplace(context);
    }
    if (settings.bloom > 0.0f) bloom.emplace(gpu);
    if (settings.show == "overdraw") overdraw.emplace(gpu_scene);
    if (settings.show == "difference") {
        reference =
            std::make_unique<Renderer>(the_scene, reference_of(settings), GlSource::current);
    }
}

void Renderer::Parts::take_up_changes() {
    if (revision == scene.revision) return;
    revision = scene.revision;
    box = bounds(scene);
    gpu_scene.refresh();
    lights.refresh();
}

// OpenGL's names are a context's own: in another renderer's they would delete its objects.
Renderer::Parts::~Parts() {
    try {
        if (gl_context) gl_context->make_current();
    } catch (const Error& error) {
        detail(error.what());  // the context is lost, and the names with it
    }
}

// From the lights to a sample's radiance, by the path that was asked for.
Radiance Renderer::Parts::light(const SampleInput& sample, FrameStats& stats) {
    return deferred ? deferred->light(sample, timer, stats) : forward->light(sample, timer, stats);
}

// The mean of the jittered samples. Sample 0, through the pixels' centres, comes last: counts, AOVs
// and views are its, since depths, ids and unit vectors have no mean.
Radiance Renderer::Parts::light_samples(const SampleInput& band, FrameStats& stats) {
    if (settings.samples <= 1) return light(band, stats);
    sum.clear();
    for (int i = settings.samples - 1; i >= 0; --i) {
        Camera jittered = band.camera;
        jittered.jitter += sample_offset(static_cast<std::uint32_t>(i));
        sum.add(light({jittered, band.rows, band.lights, band.band, true}, stats));
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

// Appends a band's light as it leaves the device: what files of linear light hold.
void Renderer::Parts::add_light(const Radiance& radiance, Frame& frame) {
    const View& view = radiance.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    append_rows(frame.radiance,
                tight_radiance(download<float>(gpu, radiance.planes, 3 * plane), view),
                3 * pixel_count());
}

// Appends what the eye sees of light that has bloomed.
void Renderer::Parts::add_display(const Radiance& glowing, Frame& frame) {
    const cl::Buffer display = tonemap.enqueue(glowing, settings.exposure, timer);
    const View& view = glowing.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    if (bloom && settings.keep_bloomed) {
        frame.bloomed = tight_radiance(download<float>(gpu, glowing.planes, 3 * plane), view);
    }
    append_rows(frame.display, tight_display(download<uint>(gpu, display, plane), view),
                4 * pixel_count());
}

void Renderer::Parts::render_band(const SampleInput& band, Frame& frame,
                                  DecodedSurfaces& surfaces) {
    const Clock::time_point start = Clock::now();
    FrameStats stats;
    const Radiance radiance = light_samples(band, stats);
    if (!bloom) {
        add_display(radiance, frame);
    } else if (band.band.rows == settings.height) {
        add_display(bloom->enqueue(radiance, settings.bloom, timer), frame);
    }  // else light spreads over the whole picture: bloom_whole()
    add_light(radiance, frame);
    take_stage_times(stats);
    add_band(frame.stats, stats);
    frame.stats.frame_ms += ms_since(start);
    if (!wants_pixels(settings)) return;
    DecodedSurfaces pixels = deferred ? deferred->pixels() : forward->pixels(band.camera);
    std::vector<Layer> layers;
    for (const std::string& name : settings.aovs) {
        layers.push_back(make_aov(name, pixels, band.camera));
    }
    append_layers(frame.aovs, std::move(layers), pixel_count());
    if (settings.show != "lit") place_surfaces(surfaces, std::move(pixels), settings.height);
}

// Light spreads over the whole picture: after the last band.
void Renderer::Parts::bloom_whole(const View& view, Frame& frame) {
    const Clock::time_point start = Clock::now();
    GrowingBuffer planes(gpu, "bloom");
    const Radiance radiance{
        planes.reserve(std::size_t{3} * sizeof(float) * view.stride * view.height), view};
    upload<float>(gpu, radiance.planes, radiance_planes(frame.radiance, view));
    add_display(bloom->enqueue(radiance, settings.bloom, timer), frame);
    take_stage_times(frame.stats);
    frame.stats.frame_ms += ms_since(start);
}

// The view in place of the lit picture.
void Renderer::Parts::show_view(const Camera& camera, double time, const DecodedSurfaces& surfaces,
                                Frame& frame) {
    std::vector<float> fragments, reference_radiance;
    if (overdraw) fragments = overdraw->count(camera, settings.width, settings.height);
    if (reference) reference_radiance = reference->render(camera, time).radiance;
    frame.display = make_view(settings.show, {surfaces, camera, context.box, fragments,
                                              frame.radiance, reference_radiance});
}

Frame Renderer::Parts::render(const Camera& camera, double time,
                              const std::function<void()>& between) {
    if (gl_context) gl_context->make_current();
    take_up_changes();
    const Clock::time_point start = Clock::now();
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.stats.zero_normals = zero_normals;
    const LightRows rows = lights.at(time, camera.position, frame.stats);
    add_stage_time(frame.stats.stages, "light_input", ms_since(start));
    const LightInput input = lights.upload(rows);
    frame.stats.frame_ms = ms_since(start);
    const std::vector<Band> bands = make_bands(settings.height, memory.band_rows);
    DecodedSurfaces surfaces;
    for (const Band& band : bands) {
        if (between) between();
        const bool redraw = raster_tile(settings.height, band.first_row).first_row == band.first_row;
        render_band({camera, rows, input, band, redraw}, frame, surfaces);
    }
    if (bloom && bands.size() > 1) {
        bloom_whole(view_of(camera, settings.width, settings.height), frame);
    }
    if (settings.show != "lit") show_view(camera, time, surfaces, frame);
    return frame;
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : parts_(in_stage("renderer", [&] { return std::make_unique<Parts>(scene, settings, gl); })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Frame Renderer::render(const Camera& camera, double time, const std::function<void()>& between) {
    return in_stage("render", [&] { return parts_->render(camera, time, between); });
}

LitSurfaces Renderer::lit_surfaces() {
    if (!parts_->deferred) {
        throw Error("renderer: the forward renderers keep no G-buffer to look at");
    }
    if (parts_->memory.band_rows < parts_->settings.height) {
        throw Error("renderer: the memory there is makes pictures of " +
                    std::to_string(parts_->settings.height) + " rows in bands of " +
                    std::to_string(parts_->memory.band_rows) + ": none is whole to look at");
    }
    return in_stage("lit surfaces", [&] { return parts_->deferred->lit_surfaces(); });
}

const DeviceInfo& Renderer::device() const {
    return parts_->gpu.info;
}
const ScenePlan& Renderer::plan() const {
    return parts_->plan;
}
const MemoryPlan& Renderer::memory() const {
    return parts_->memory;
}

}  // namespace kilolux
