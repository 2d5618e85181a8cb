// SPDX-License-Identifier: Apache-2.0
#include "host/picture/frame_reader.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "host/base/system/parallel.h"
#include "host/picture/frame.h"

namespace kilolux {
namespace {

// All cores copy rows: memory that is written for the first time is slow on one.

void put_display(const std::byte* codes, const View& view, uint* pixels, std::size_t stride) {
    parallel_for(std::size_t{0}, std::size_t{view.height}, [&](std::size_t y) {
        std::memcpy(pixels + y * stride, codes + sizeof(uint) * y * view.stride,
                    sizeof(uint) * view.width);
    });
}

void put_light(const std::byte* light, const View& view, std::vector<float>& rgb) {
    const auto* planes = reinterpret_cast<const float*>(light);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    float* first = &rgb[std::size_t{3} * view.width * view.first_row];
    parallel_for(std::size_t{0}, std::size_t{view.height}, [&](std::size_t y) {
        const float* row = planes + y * view.stride;
        float* out = first + 3 * y * view.width;
        for (std::size_t x = 0; x < view.width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) *out++ = row[c * plane + x];
        }
    });
}

}  // namespace

// The read into `place`; it replaces an earlier one into the same place.
FrameReader::Staged& FrameReader::staged_for(const void* place) {
    auto found = std::ranges::find(staged_, place, &Staged::place);
    if (found == staged_.end())
        found = std::ranges::find_if(staged_, [](const Staged& s) { return !s.place; });
    Staged& out = found != staged_.end() ? *found : staged_.emplace_back(gpu_);
    out.place = place;
    return out;
}

void FrameReader::read(const cl::Buffer& buffer, std::size_t bytes, void* to, StageTimer& timer) {
    cl::Event event;
    gpu_.queue.enqueueReadBuffer(buffer, CL_FALSE, 0, bytes, to, nullptr, &event);
    timer.record(kReadBackStage, event);
}

void FrameReader::read_rows(const cl::Buffer& display, const View& view,
                            const std::vector<DisplayRows>& rows, void* to, StageTimer& timer) {
    const std::size_t row_bytes = sizeof(uint) * view.stride;
    if (rows.empty()) return read(display, row_bytes * view.height, to, timer);
    if (!beside_) beside_.emplace(gpu_.context, gpu_.device, CL_QUEUE_PROFILING_ENABLE);
    gpu_.queue.flush();  // the other queue waits for its commands
    for (const DisplayRows& part : rows) {
        const std::size_t first = row_bytes * part.first;
        const std::vector<cl::Event> made = {part.done};
        cl::Event event;
        beside_->enqueueReadBuffer(display, CL_FALSE, first, row_bytes * part.count,
                                   static_cast<std::byte*>(to) + first, &made, &event);
        timer.record_beside(kReadBackStage, event);
    }
    beside_->flush();
}

void FrameReader::read_display(const cl::Buffer& display, const View& view,
                               const std::vector<DisplayRows>& rows, std::span<uint> pixels,
                               std::size_t to_stride, StageTimer& timer) {
    uint* first = &pixels[to_stride * view.first_row];
    if (gpu_.info.is_cpu) {  // nothing to stage: the device's memory is the host's
        const std::size_t row = sizeof(uint) * view.width;
        cl::Event event;
        gpu_.queue.enqueueReadBufferRect(display, CL_FALSE, {0, 0, 0}, {0, 0, 0},
                                         {row, view.height, 1}, sizeof(uint) * view.stride, 0,
                                         sizeof(uint) * to_stride, 0, first, nullptr, &event);
        timer.record(kReadBackStage, event);
        return;
    }
    Staged& out = staged_for(first);
    std::byte* codes = out.pinned.reserve(sizeof(uint) * view.stride * view.height);
    read_rows(display, view, rows, codes, timer);
    out.put = [=] { put_display(codes, view, first, to_stride); };
}

void FrameReader::read_light(const Radiance& radiance, std::vector<float>& rgb, StageTimer& timer) {
    const View view = radiance.view;
    Staged& out = staged_for(&rgb);
    const std::size_t bytes = 3 * sizeof(float) * view.stride * view.height;
    std::byte* light = out.pinned.reserve(bytes);
    read(radiance.planes, bytes, light, timer);
    out.put = [=, &rgb] { put_light(light, view, rgb); };
}

void FrameReader::reset() {
    wait_beside();
    for (Staged& staged : staged_) staged.place = nullptr;
}

double FrameReader::finish() {
    gpu_.queue.finish();
    wait_beside();
    const auto start = std::chrono::steady_clock::now();
    for (const Staged& staged : staged_) {
        if (staged.place) staged.put();
    }
    reset();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace kilolux
