// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <fmt/format.h>
#include <chrono>
#include <cstring>
#include <utility>

#include "host/base/error.h"
#include "host/picture/frame_bands.h"
#include "host/picture/views.h"
#include "host/render/host_stages.h"
#include "host/render/pipeline.h"

namespace kilolux {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

// A frame: its lights, then band by band surfaces -> lighting -> bloom -> tonemap -> picture.
Frame Pipeline::render(const Camera& camera, double time, DisplayMemory display_memory,
                       int samples) {
    display_memory_ = display_memory;
    try {
        return make_frame(camera, time, samples);
    } catch (const Interrupted&) {
        throw;
    } catch (...) {
        is_sound_ = false;
        throw;
    }
}

Frame Pipeline::make_frame(const Camera& camera, double time, int samples) {
    refine(camera, time, samples);
    Frame frame;
    const QueueDrain drain(gpu.queue);
    const LightInput lights = begin(camera, time, frame);
    for (const Band& band : make_bands(settings.height, memory.band_rows)) {
        const int tile = raster_tile(settings.height, band.first_row).first_row;
        render_band({camera, rows_, lights, band, tile == band.first_row}, frame);
    }
    if (blooms_at_end()) bloom_whole(frame);
    if (settings.want.view != ViewKind::lit) show_view(time, frame);
    if (!settings.want.radiance) frame.radiance.clear();
    keep_refined(camera, time);
    return frame;
}

// The frame's size, and its lights on the device.
LightInput Pipeline::begin(const Camera& camera, double time, Frame& frame) {
    scene->make_current();
    scene->take_up_changes();
    const Clock::time_point start = Clock::now();
    timer_ = StageTimer();  // without what a frame that failed left
    reader_.reset();
    camera_ = camera;
    const FrameRequest& want = settings.want;
    frame.width = settings.width;
    frame.height = settings.height;
    const auto pixels =
        static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    const bool shown_only = !display_memory_.empty();
    if (want.display && !shown_only) frame.display.resize(4 * pixels);
    if ((want.radiance && !shown_only) || want.view == ViewKind::difference) {
        frame.radiance.resize(3 * pixels);
    }
    if (want.bloomed && settings.bloom > 0.0f) frame.bloomed.resize(3 * pixels);
    if (blooms_at_end()) {
        const View view = view_of(camera, settings.width, settings.height);
        whole_light_.reserve(std::size_t{3} * view.stride * view.height);
    }
    frame.stats.zero_normals = scene->zero_normals();
    const Clock::time_point lights_start = Clock::now();
    lights_.update(time, camera, frame.stats);
    add_host_time({timer_, frame.stats}, kLightInputStage, ms_since(lights_start));
    const LightInput input = lights_.input(camera.position, !settings.no_reuse, timer_);
    if (lights_on_host()) {
        const Clock::time_point rows_start = Clock::now();
        rows_ = lights_.rows(camera.position);
        add_host_time({timer_, frame.stats}, kLightInputStage, ms_since(rows_start));
    }
    frame.stats.frame_ms = ms_since(start);
    return input;
}

void Pipeline::render_band(const Sample& band, Frame& frame) {
    const Clock::time_point start = Clock::now();
    FrameStats stats;
    Sample lit = band;
    if (context_.shades_display()) {
        lit.display = display_target(view_of(camera_, settings.width, settings.height, band.band));
    }
    light_samples(lit, {timer_, stats}, [&](const Radiance& radiance) {
        if (lit.display) return read_display(*lit.display, frame);
        develop(radiance, frame);
    });
    const double placed_ms = reader_.finish();
    if (placed_ms > 0.0) timer_.record_host(placed_ms);
    add_times(timer_, stats);
    add_stage_time(stats.stages, kReadBackStage, placed_ms);
    add_band(frame.stats, stats);
    frame.stats.frame_ms += ms_since(start);
    if (settings.want.pixels()) add_pixels(band, frame);
}

// From a band's light to what the caller wants of it.
void Pipeline::develop(const Radiance& radiance, Frame& frame) {
    if (!frame.radiance.empty()) reader_.read_light(radiance, frame.radiance, timer_);
    if (!blooms_at_end()) return show(radiance, frame);
    const View& view = radiance.view;
    const std::size_t row = sizeof(float) * view.stride;
    gpu.queue.enqueueCopyBufferRect(radiance.planes, whole_light_.get().buffer(), {0, 0, 0},
                                    {0, view.first_row, 0}, {row, view.height, 3}, row,
                                    row * view.height, row,
                                    row * static_cast<std::size_t>(settings.height));
}

// Light spreads over the whole picture: after the last band.
void Pipeline::bloom_whole(Frame& frame) {
    const Clock::time_point start = Clock::now();
    show({whole_light_.get(), view_of(camera_, settings.width, settings.height)}, frame);
    const double placed_ms = reader_.finish();
    if (placed_ms > 0.0) timer_.record_host(placed_ms);
    add_times(timer_, frame.stats);
    add_stage_time(frame.stats.stages, kReadBackStage, placed_ms);
    frame.stats.frame_ms += ms_since(start);
}

// Bloom -> tonemap -> picture.
void Pipeline::show(const Radiance& radiance, Frame& frame) {
    const Radiance glowing =
        settings.bloom > 0.0f ? bloom_->enqueue(radiance, settings.bloom, timer_) : radiance;
    if (!frame.bloomed.empty()) reader_.read_light(glowing, frame.bloomed, timer_);
    if (display_memory_.empty() && frame.display.empty()) return;
    const DisplayTarget display = display_target(glowing.view);
    tonemap_.enqueue(glowing, display, timer_);
    read_display(display, frame);
}

// A CPU device's kernels write to the caller's memory themselves.
DisplayTarget Pipeline::display_target(const View& view) {
    if (!is_written_by_device()) return tonemap_.target(view, settings.exposure);
    const cl::Buffer pixels(gpu.context, CL_MEM_WRITE_ONLY | CL_MEM_USE_HOST_PTR,
                            display_memory_.size_bytes(), display_memory_.data());
    return tonemap_.target({pixels, display_memory_.size()}, view, settings.exposure);
}

void Pipeline::read_display(const DisplayTarget& display, Frame& frame) {
    if (is_written_by_device()) {
        void* mapped = gpu.queue.enqueueMapBuffer(display.pixels, CL_FALSE, CL_MAP_READ, 0,
                                                  display_memory_.size_bytes());
        gpu.queue.enqueueUnmapMemObject(display.pixels, mapped);
        return;
    }
    if (!display_memory_.empty() && display_memory_.data() == shown_.data<uint>()) {
        cl::Event event;
        gpu.queue.enqueueReadBuffer(display.pixels, CL_FALSE, 0, display_memory_.size_bytes(),
                                    display_memory_.data(), nullptr, &event);
        return timer_.record(kReadBackStage, event);
    }
    if (!display_memory_.empty()) {
        return reader_.read_display(display.pixels, display.view, display_memory_,
                                    display.view.stride, timer_);
    }
    const std::span<uint> pixels(reinterpret_cast<uint*>(frame.display.data()),
                                 frame.display.size() / sizeof(uint));
    reader_.read_display(display.pixels, display.view, pixels,
                         static_cast<std::size_t>(frame.width), timer_);
}

DisplayMemory Pipeline::display_memory() {
    const std::size_t pixels =
        display_stride(settings.width) * static_cast<std::size_t>(settings.height);
    if (!gpu.info.is_cpu) {
        shown_.reserve(pixels * sizeof(uint));
        return {shown_.data<uint>(), pixels};
    }
    host_shown_.resize(pixels);
    return host_shown_;
}

// A band's AOVs, and its surfaces for a view.
void Pipeline::add_pixels(const Sample& band, Frame& frame) {
    DecodedSurfaces pixels =
        std::visit([&](auto& path) { return path.pixels(band.camera); }, path());
    if (settings.auto_samples.on) {
        pixels.variance = download(gpu, until_error_->variance());
        pixels.taken = until_error_->taken();
    }
    std::vector<Layer> layers;
    for (const std::string& name : settings.want.aovs) {
        layers.push_back(make_aov(name, pixels, band.camera));
    }
    append_layers(frame.aovs, std::move(layers),
                  static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
    if (settings.want.view != ViewKind::lit) {
        place_surfaces(surfaces_, std::move(pixels), settings.height);
    }
}

// The view in place of the lit picture.
void Pipeline::show_view(double time, Frame& frame) {
    std::vector<float> fragments, reference_light;
    const ViewKind view = settings.want.view;
    if (view == ViewKind::overdraw) {
        fragments = overdraw_->count(camera_, settings.width, settings.height);
    }
    if (view == ViewKind::difference) {
        reference_light = reference_->render(camera_, time, {}, 0).radiance;
    }
    frame.display = make_view(
        view, {surfaces_, camera_, scene->box(), fragments, frame.radiance, reference_light});
    surfaces_ = {};
}

void Pipeline::require_whole(const char* what) const {
    if (is_whole()) return;
    throw Error(fmt::format(
        "{}: the picture is made in bands of {} rows; it needs the whole (--max-memory)", what,
        memory.band_rows));
}

PixelProbe Pipeline::probe(int x, int y) {
    PixelProbe out = std::visit([&](auto& path) { return path.probe(camera_, x, y); }, path());
    const View view = view_of(camera_, settings.width, settings.height);
    const LightRows rows = lights_.rows(camera_.position);
    for (ProbedLight& light : out.lights) {
        light.light = rows.local.at(light.index);
        light.shade = shade_light(view, light.light, light.index, tail_seed(settings, 0));
        if (rows.profiles.empty()) continue;
        AimedProfile row = rows.profiles.at(light.index);
        row = {rotated(view, row.down, row.down.w), rotated(view, row.side, row.side.w)};
        light.web = webs_in_view(std::span(&row, 1), scene->scene()).front();
    }
    return out;
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

std::size_t display_stride(int width) { return view_of(Camera{}, width, 1).stride; }

Frame Renderer::render(const Camera& camera, double time) {
    return in_stage("render", [&] { return pipeline_->render(camera, time, {}, 0); });
}

Frame Renderer::render_to(std::span<uint> pixels, const Camera& camera, double time, int samples) {
    const RenderSettings& s = settings();
    const std::size_t stride = display_stride(s.width);
    pixels = pixels.first(stride * static_cast<std::size_t>(s.height));
    const bool direct = s.want.view == ViewKind::lit && pipeline_->is_whole();
    return in_stage("render", [&] {
        Frame frame = pipeline_->render(camera, time, direct ? pixels : DisplayMemory(), samples);
        if (direct) return frame;
        const auto row = static_cast<std::size_t>(s.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(s.height); ++y) {
            std::memcpy(&pixels[y * stride], &frame.display[4 * y * row], 4 * row);
        }
        frame.display.clear();
        return frame;
    });
}

LitSurfaces Renderer::lit_surfaces() {
    pipeline_->require_whole("lit surfaces");
    return in_stage("lit surfaces", [&] {
        return std::visit(
            [](auto& path) -> LitSurfaces {
                if constexpr (requires { path.lit_surfaces(); }) {
                    return path.lit_surfaces();
                } else {
                    throw Error("renderer: the forward renderers keep no G-buffer to look at");
                }
            },
            pipeline_->path());
    });
}

std::span<uint> Renderer::display_memory() {
    return in_stage("display memory", [&] { return pipeline_->display_memory(); });
}

PixelProbe Renderer::probe(int x, int y) {
    pipeline_->require_whole("probe");
    pipeline_->scene->make_current();
    return in_stage("probe", [&] { return pipeline_->probe(x, y); });
}

std::vector<ActiveCluster> Renderer::active_clusters() const {
    const auto* path = std::get_if<DeferredPath>(&pipeline_->path());
    if (path == nullptr) return {};
    return in_stage("active clusters", [&] { return path->active_clusters(); });
}

std::uint64_t Renderer::light_count(const RenderSettings& settings) const {
    return settings.lights.count + pipeline_->scene->scene().lights.size();
}

const Scene& Renderer::scene() const { return pipeline_->scene->scene(); }
const RenderSettings& Renderer::settings() const { return pipeline_->settings; }
const DeviceInfo& Renderer::device() const { return pipeline_->gpu.info; }
const ScenePlan& Renderer::plan() const { return pipeline_->plan; }
const MemoryPlan& Renderer::memory() const { return pipeline_->memory; }
const Gpu& Renderer::gpu() const { return pipeline_->gpu; }

}  // namespace kilolux
