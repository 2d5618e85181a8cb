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
    if ((want.radiance && !shown_only) || want.view == ViewKind::difference || (by_rows && whole)) {
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
    if (waits_for_bands() && !by_rows) {
        const RenderSettings& settings = context_.settings;
        const View view = view_of(Camera{}, settings.width, settings.height);
        whole_light_.reserve(std::size_t{3} * view.stride * view.height);
    }
}

// A CPU device's kernels write to the caller's memory themselves.
DisplayTarget PictureOutput::target(const View& view) {
    const float exposure = context_.settings.exposure;
    if (!is_written_by_device()) return tonemap_.target(view, exposure);
    const cl::Buffer pixels(context_.gpu.context, CL_MEM_WRITE_ONLY | CL_MEM_USE_HOST_PTR,
                            memory_.size_bytes(), memory_.data());
    return tonemap_.target({pixels, memory_.size()}, view, exposure);
}

bool PictureOutput::keep_for_whole(const Radiance& light) {
    if (!waits_for_bands()) return false;
    if (by_rows_) return true;  // it is read
    const View& view = light.view;
    const std::size_t row = sizeof(float) * view.stride;
    context_.gpu.queue.enqueueCopyBufferRect(
        light.planes, whole_light_.get().buffer(), {0, 0, 0}, {0, view.first_row, 0},
        {row, view.height, 3}, row, row * view.height, row,
        row * static_cast<std::size_t>(context_.settings.height));
    return true;
}

std::optional<Radiance> PictureOutput::whole_light(const Camera& camera, const Frame& frame) {
    if (!waits_for_bands()) return {};
    const RenderSettings& settings = context_.settings;
    const View view = view_of(camera, settings.width, settings.height);
    if (by_rows_) upload(frame, view);
    return Radiance{whole_light_.get(), view};
}

void PictureOutput::upload(const Frame& frame, const View& view) {
    const std::size_t size = std::size_t{view.stride} * view.height;
    whole_light_.reserve(3 * size);
    std::vector<float> plane(size);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t y = 0; y < view.height; ++y) {
            const float* row = &frame.radiance[3 * y * view.width + c];
            for (std::size_t x = 0; x < view.width; ++x) plane[y * view.stride + x] = row[3 * x];
        }
        context_.gpu.queue.enqueueWriteBuffer(whole_light_.get().buffer(), CL_TRUE,
                                              sizeof(float) * c * size, sizeof(float) * size,
                                              plane.data());
    }
}

Radiance PictureOutput::finished(const Radiance& light, StageTimer& timer) {
    return stages_.enqueue(light, context_.settings, timer);
}

std::optional<DisplayTarget> PictureOutput::tonemap(const Radiance& light, StageTimer& timer) {
    if (memory_.empty() && display_.empty()) return {};
    const DisplayTarget display = target(light.view);
    tonemap_.enqueue(light, display, timer, backdrop_);
    return display;
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
