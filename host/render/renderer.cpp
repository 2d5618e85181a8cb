// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <chrono>
#include <cstring>

#include "host/picture/bands.h"
#include "host/picture/frame_bands.h"
#include "host/picture/sample_pattern.h"
#include "host/picture/views.h"
#include "host/render/renderer_parts.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

std::size_t display_stride(int width) { return view_of(Camera{}, width, 1).stride; }

// From the lights to a sample's radiance, by the path that was asked for.
Radiance Renderer::Parts::light(const SampleInput& sample, FrameStats& stats) {
    const RendererKind kind = settings.renderer;
    return is_forward(kind) ? forward.at(kind).light(sample, timer, stats)
                            : deferred.at(kind).light(sample, timer, stats);
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
    if (settings.bloom > 0.0f && settings.keep_bloomed) {
        frame.bloomed = tight_radiance(download<float>(gpu, glowing.planes, 3 * plane), view);
    }
    append_rows(frame.display, tight_display(download<uint>(gpu, display, plane), view),
                4 * pixel_count());
}

Radiance Renderer::Parts::glowing(const Radiance& radiance) {
    return settings.bloom > 0.0f ? bloom->enqueue(radiance, settings.bloom, timer) : radiance;
}

void Renderer::Parts::render_band(const SampleInput& band, Frame& frame,
                                  DecodedSurfaces& surfaces) {
    const Clock::time_point start = Clock::now();
    FrameStats stats;
    const Radiance radiance = light_samples(band, stats);
    if (settings.bloom <= 0.0f || band.band.rows == settings.height) {
        add_display(glowing(radiance), frame);
    }  // else light spreads over the whole picture: bloom_whole()
    add_light(radiance, frame);
    take_stage_times(stats);
    add_band(frame.stats, stats);
    frame.stats.frame_ms += ms_since(start);
    add_surfaces(band, frame, surfaces);
}

// A band's AOVs, and its surfaces for a view.
void Renderer::Parts::add_surfaces(const SampleInput& band, Frame& frame,
                                   DecodedSurfaces& surfaces) {
    if (!wants_pixels(settings)) return;
    const RendererKind kind = settings.renderer;
    DecodedSurfaces pixels =
        is_forward(kind) ? forward.at(kind).pixels(band.camera) : deferred.at(kind).pixels();
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
    if (settings.show == "overdraw") {
        fragments = overdraw->count(camera, settings.width, settings.height);
    }
    if (settings.show == "difference") {
        reference_radiance = reference->render(camera, time, {}).radiance;
    }
    frame.display = make_view(settings.show, {surfaces, camera, context.box, fragments,
                                              frame.radiance, reference_radiance});
}

// The frame's size, and its lights on the device.
LightInput Renderer::Parts::begin(const Camera& camera, double time, Frame& frame) {
    scene->make_current();
    scene->take_up_changes();
    const Clock::time_point start = Clock::now();
    timer = StageTimer();  // without the events of a frame that failed
    last_camera = camera;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.stats.zero_normals = scene->zero_normals();
    rows = lights.at(time, camera.position, frame.stats);
    add_stage_time(frame.stats.stages, "light_input", ms_since(start));
    LightInput input = lights.upload(rows);
    frame.stats.frame_ms = ms_since(start);
    return input;
}

Frame Renderer::Parts::render(const Camera& camera, double time,
                              const std::function<void()>& between) {
    Frame frame;
    const LightInput input = begin(camera, time, frame);
    const std::vector<Band> bands = make_bands(settings.height, memory.band_rows);
    DecodedSurfaces surfaces;
    for (const Band& band : bands) {
        if (between) between();
        const bool redraw =
            raster_tile(settings.height, band.first_row).first_row == band.first_row;
        render_band({camera, rows, input, band, redraw}, frame, surfaces);
    }
    if (settings.bloom > 0.0f && bands.size() > 1) {
        bloom_whole(view_of(camera, settings.width, settings.height), frame);
    }
    if (settings.show != "lit") show_view(camera, time, surfaces, frame);
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
    if (settings.show != "lit" || !is_whole()) {
        Frame frame = render(camera, time, {});
        const auto row = static_cast<std::size_t>(settings.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(settings.height); ++y) {
            std::memcpy(&pixels[y * stride], &frame.display[4 * y * row], 4 * row);
        }
        frame.display.clear();
        frame.radiance.clear();
        return frame;
    }
    Frame frame;
    const LightInput input = begin(camera, time, frame);
    const Clock::time_point start = Clock::now();
    const SampleInput whole{camera, rows, input, {0, settings.height}, true};
    FrameStats stats;
    develop_to(pixels, light_samples(whole, stats));
    take_stage_times(stats);
    add_band(frame.stats, stats);
    frame.stats.frame_ms += ms_since(start);
    DecodedSurfaces unseen;
    add_surfaces(whole, frame, unseen);
    return frame;
}

// What is on the device is the last band's.
void Renderer::Parts::require_whole(const char* what) const {
    if (is_whole()) return;
    throw Error(std::string(what) + ": the picture is made in bands of " +
                std::to_string(memory.band_rows) + " rows; it needs the whole (--max-memory)");
}

PixelProbe Renderer::Parts::probe(int x, int y) {
    require_whole("probe");
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

const RenderSettings& Renderer::settings() const { return parts_->settings; }

Frame Renderer::render(const Camera& camera, double time, const std::function<void()>& between) {
    return in_stage("render", [&] { return parts_->render(camera, time, between); });
}

Frame Renderer::render_to(std::span<uint> pixels, const Camera& camera, double time) {
    return in_stage("render", [&] { return parts_->render_to(pixels, camera, time); });
}

LitSurfaces Renderer::lit_surfaces() {
    parts_->require_whole("lit surfaces");
    const auto found = parts_->deferred.find(parts_->settings.renderer);
    if (found == parts_->deferred.end()) {
        throw Error("renderer: the forward renderers keep no G-buffer to look at");
    }
    return in_stage("lit surfaces", [&] { return found->second.lit_surfaces(); });
}

std::uint64_t Renderer::light_count(const RenderSettings& settings) const {
    return settings.lights.count + parts_->scene->scene().lights.size();
}

PixelProbe Renderer::probe(int x, int y) {
    parts_->scene->make_current();
    return in_stage("probe", [&] { return parts_->probe(x, y); });
}

std::vector<ActiveCluster> Renderer::active_clusters() const {
    const auto found = parts_->deferred.find(RendererKind::deferred);
    if (parts_->settings.renderer != RendererKind::deferred || found == parts_->deferred.end()) {
        return {};
    }
    return in_stage("active clusters", [&] { return found->second.active_clusters(); });
}

const DeviceInfo& Renderer::device() const { return parts_->gpu.info; }
const ScenePlan& Renderer::plan() const { return parts_->plan; }
const MemoryPlan& Renderer::memory() const { return parts_->memory; }
const Gpu& Renderer::gpu() const { return parts_->gpu; }

}  // namespace kilolux
