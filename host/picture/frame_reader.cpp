// SPDX-License-Identifier: Apache-2.0
#include "host/picture/frame_reader.h"

#include <tbb/parallel_for.h>

#include <chrono>
#include <cstring>

namespace kilolux {
namespace {

constexpr std::size_t kRowsAtOnce = 64;

// Calls each(y) for every row: memory that is written for the first time is slow on one core.
template <typename Each>
void for_each_row(std::size_t rows, const Each& each) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows, kRowsAtOnce),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t y = range.begin(); y < range.end(); ++y) each(y);
                      });
}

// The entry of a list whose `member` is `key`, or one that is free.
template <typename Entry, typename Key>
Entry& entry_of(std::list<Entry>& entries, Key* Entry::*member, Key* key, const Gpu& gpu) {
    Entry* free = nullptr;
    for (Entry& entry : entries) {
        if (entry.*member == key) return entry;
        if (entry.*member == nullptr) free = &entry;
    }
    Entry& out = free != nullptr ? *free : entries.emplace_back(gpu);
    out.*member = key;
    return out;
}

}  // namespace

void FrameReader::stage(Staged& staged, const cl::Buffer& buffer, const View& view,
                        std::size_t bytes, StageTimer& timer) {
    std::byte* to = staged.pinned.reserve(bytes);
    staged.view = view;
    staged.source = to;
    cl::Event event;
    gpu_.queue.enqueueReadBuffer(buffer, CL_FALSE, 0, bytes, to, nullptr, &event);
    timer.record(kReadBackStage, event);
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
    Display& out = entry_of(displays_, &Display::pixels, first, gpu_);
    out.stride = to_stride;
    stage(out, display, view, sizeof(uint) * view.stride * view.height, timer);
}

void FrameReader::read_light(const Radiance& radiance, std::vector<float>& rgb, StageTimer& timer) {
    const View& view = radiance.view;
    Light& out = entry_of(lights_, &Light::rgb, &rgb, gpu_);
    stage(out, radiance.planes, view, 3 * sizeof(float) * view.stride * view.height, timer);
}

void FrameReader::place(const Display& display) {
    const View& view = display.view;
    for_each_row(view.height, [&](std::size_t y) {
        std::memcpy(display.pixels + y * display.stride,
                    display.source + sizeof(uint) * y * view.stride, sizeof(uint) * view.width);
    });
}

void FrameReader::place(const Light& light) {
    const View& view = light.view;
    const auto* planes = reinterpret_cast<const float*>(light.source);
    const std::size_t plane = std::size_t{view.stride} * view.height;
    float* first = &(*light.rgb)[std::size_t{3} * view.width * view.first_row];
    for_each_row(view.height, [&](std::size_t y) {
        const float* row = planes + y * view.stride;
        float* out = first + 3 * y * view.width;
        for (std::size_t x = 0; x < view.width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) *out++ = row[c * plane + x];
        }
    });
}

void FrameReader::reset() {
    for (Light& light : lights_) light.rgb = nullptr;
    for (Display& display : displays_) display.pixels = nullptr;
}

double FrameReader::finish() {
    gpu_.queue.finish();
    const auto start = std::chrono::steady_clock::now();
    for (const Light& light : lights_) {
        if (light.rgb) place(light);
    }
    for (const Display& display : displays_) {
        if (display.pixels) place(display);
    }
    reset();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace kilolux
