// SPDX-License-Identifier: Apache-2.0
#include "host/render/picture_output.h"

#include "host/render/environment_light.h"
#include "host/render/renderer.h"
#include "host/render/samples.h"

namespace kilolux {

PictureOutput::PictureOutput(const RenderContext& context)
    : context_(context),
      tone_curve_(static_cast<int>(context.settings.tone_curve)),
      tonemap_(context.gpu, context.tuning, tone_curve_),
      whole_light_(context.gpu, "whole light"),
      reader_(context.gpu),
      shown_(context.gpu) {
    set(context.settings);
}

void PictureOutput::set(const RenderSettings& settings) {
    stages_.set(context_.gpu, settings);
    const int tone_curve = static_cast<int>(settings.tone_curve);
    if (tone_curve != tone_curve_) tonemap_ = Tonemap(context_.gpu, context_.tuning, tone_curve);
    tone_curve_ = tone_curve;
    backdrop_ = backdrop_of(settings);
}

void PictureOutput::resize(Frame& frame, Band rows, bool shown_only, bool by_rows) const {
    const RenderSettings& settings = context_.settings;
    const FrameRequest& want = settings.want;
    frame.width = settings.width;
    frame.height = rows.rows;
    frame.first_row = rows.first_row;
    const auto pixels =
        static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    Frame spare = spares_->take();
    const auto resize_spare = [&spare](auto Frame::*member, Frame& to, std::size_t values) {
        to.*member = std::move(spare.*member);
        (to.*member).resize(values);
    };
    if (want.display && !shown_only) resize_spare(&Frame::display, frame, 4 * pixels);
    const bool whole = needs_whole_picture(settings);
    if ((want.radiance && !shown_only) || shows_radiance(want.view) || (by_rows && whole)) {
        resize_spare(&Frame::radiance, frame, 3 * pixels);
    }
    if (want.shown_light && whole) resize_spare(&Frame::shown_light, frame, 3 * pixels);
}

void PictureOutput::begin(DisplayMemory memory, Frame& frame, bool by_rows) {
    reader_.reset();
    memory_ = memory;
    by_rows_ = by_rows;
    first_row_ = static_cast<uint>(frame.first_row);
    display_ = {reinterpret_cast<uint*>(frame.display.data()), frame.display.size() / sizeof(uint)};
    if (waits_for_bands() && !by_rows) whole_light();  // before bands take memory
}

// A CPU device's kernels write to the caller's memory themselves.
DisplayTarget PictureOutput::target(const View& view) {
    const float exposure = context_.settings.exposure;
    if (!is_written_by_device()) return tonemap_.target(view, exposure);
    const cl::Buffer pixels(context_.gpu.context, CL_MEM_WRITE_ONLY | CL_MEM_USE_HOST_PTR,
                            memory_.size_bytes(), memory_.data());
    return tonemap_.target({pixels, memory_.size()}, view, exposure);
}

// Room for the light of all bands.
Radiance PictureOutput::whole_light() {
    const RenderSettings& settings = context_.settings;
    const View view = view_of(Camera{}, settings.width, settings.height);
    return {whole_light_.reserve(std::size_t{3} * view.stride * view.height), view};
}

void PictureOutput::keep(const Radiance& light) {
    const View& view = light.view;
    const std::size_t row = sizeof(float) * view.stride;
    context_.gpu.queue.enqueueCopyBufferRect(
        light.planes, whole_light_.get().buffer(), {0, 0, 0}, {0, view.first_row, 0},
        {row, view.height, 3}, row, row * view.height, row,
        row * static_cast<std::size_t>(context_.settings.height));
}

void PictureOutput::bloom(LitBand& band, StageTimer& timer) {
    const RenderSettings& settings = context_.settings;
    if (band.display) return;  // shading has made it
    Radiance light = band.light;
    if (waits_for_bands()) {
        if (by_rows_) return;
        keep(light);
        const View& view = light.view;
        if (view.first_row + view.height < static_cast<uint>(settings.height)) return;
        light = whole_light();
    }
    band.shown = stages_.enqueue(light, settings, timer);
}

void PictureOutput::bloom_rows(const Frame& frame, LitBand& band, StageTimer& timer) {
    const Radiance light = whole_light();
    const View& view = light.view;
    const std::size_t size = std::size_t{view.stride} * view.height;
    std::vector<float> plane(size);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t y = 0; y < view.height; ++y) {
            const float* row = &frame.radiance[3 * y * view.width + c];
            for (std::size_t x = 0; x < view.width; ++x) plane[y * view.stride + x] = row[3 * x];
        }
        context_.gpu.queue.enqueueWriteBuffer(light.planes, CL_TRUE, sizeof(float) * c * size,
                                              sizeof(float) * size, plane.data());
    }
    band.shown = stages_.enqueue(light, context_.settings, timer);
}

void PictureOutput::tonemap(LitBand& band, StageTimer& timer) {
    if (!band.shown || (memory_.empty() && display_.empty())) return;
    band.display = target(band.shown->view);
    tonemap_.enqueue(*band.shown, *band.display, timer, backdrop_);
}

void PictureOutput::read(const LitBand& band, Frame& frame, StageTimer& timer) {
    if (band.light.planes.buffer()()) read_light(band.light, frame.radiance, timer);
    if (band.shown) read_light(*band.shown, frame.shown_light, timer);
    if (band.display) read_display(*band.display, timer);
}

void PictureOutput::read_light(const Radiance& light, std::vector<float>& to, StageTimer& timer) {
    if (!to.empty()) reader_.read_light({light.planes, in_frame(light.view)}, to, timer);
}

// The band within the frame's rows.
View PictureOutput::in_frame(View view) const {
    view.first_row -= first_row_;
    return view;
}

void PictureOutput::read_display(const DisplayTarget& display, StageTimer& timer) {
    const cl::CommandQueue& queue = context_.gpu.queue;
    if (is_written_by_device()) {
        void* mapped =
            queue.enqueueMapBuffer(display.pixels, CL_FALSE, CL_MAP_READ, 0, memory_.size_bytes());
        queue.enqueueUnmapMemObject(display.pixels, mapped);
    } else if (!memory_.empty() && memory_.data() == shown_.data<uint>()) {
        cl::Event event;
        queue.enqueueReadBuffer(display.pixels, CL_FALSE, 0, memory_.size_bytes(), memory_.data(),
                                nullptr, &event);
        timer.record(kReadBackStage, event);
    } else if (!memory_.empty()) {
        reader_.read_display(display.pixels, display.view, memory_, display.view.stride, timer);
    } else {
        reader_.read_display(display.pixels, in_frame(display.view), display_,
                             static_cast<std::size_t>(context_.settings.width), timer);
    }
}

void PictureOutput::finish(StageTimer& timer, FrameStats& stats) {
    timer.gather();  // while the device copies the picture
    const double placed_ms = reader_.finish();
    if (placed_ms > 0.0) timer.record_host(kReadBackStage, placed_ms);
    add_times(context_.gpu, timer, stats);
}

DisplayMemory PictureOutput::display_memory() {
    const RenderSettings& settings = context_.settings;
    const std::size_t pixels =
        display_stride(settings.width) * static_cast<std::size_t>(settings.height);
    if (!context_.gpu.info.is_cpu) {
        shown_.reserve(pixels * sizeof(uint));
        return {shown_.data<uint>(), pixels};
    }
    host_shown_.resize(pixels);
    return host_shown_;
}

}  // namespace kilolux
