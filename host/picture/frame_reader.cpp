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

const std::byte* FrameReader::read(Staged& staged, const cl::Buffer& buffer, std::size_t bytes,
                                   StageTimer& timer) {
    std::byte* to = staged.pinned.reserve(bytes);
    cl::Event event;
    gpu_.queue.enqueueReadBuffer(buffer, CL_FALSE, 0, bytes, to, nullptr, &event);
    timer.record(kReadBackStage, event);
    return to;
}

void FrameReader::read_display(const cl::Buffer& display, const View& view, std::span<uint> pixels,
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
    const std::byte* codes = read(out, display, sizeof(uint) * view.stride * view.height, timer);
    out.put = [=] { put_display(codes, view, first, to_stride); };
}

void FrameReader::read_light(const Radiance& radiance, std::vector<float>& rgb, StageTimer& timer) {
    const View view = radiance.view;
    Staged& out = staged_for(&rgb);
    const std::byte* light =
        read(out, radiance.planes, 3 * sizeof(float) * view.stride * view.height, timer);
    out.put = [=, &rgb] { put_light(light, view, rgb); };
}

void FrameReader::reset() {
    for (Staged& staged : staged_) staged.place = nullptr;
}

double FrameReader::finish() {
    gpu_.queue.finish();
    const auto start = std::chrono::steady_clock::now();
    for (const Staged& staged : staged_) {
        if (staged.place) staged.put();
    }
    reset();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace kilolux
