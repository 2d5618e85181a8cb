// SPDX-License-Identifier: Apache-2.0
#include "host/picture/frame_reader.h"

#include <algorithm>

namespace kilolux {

void FrameReader::read_display(const cl::Buffer& display, const View& view, Frame& frame) {
    const std::size_t row = sizeof(uint) * view.width;
    gpu_.queue.enqueueReadBufferRect(display, CL_FALSE, {0, 0, 0}, {0, 0, 0}, {row, view.height, 1},
                                     sizeof(uint) * view.stride, 0, row, 0,
                                     &frame.display[row * view.first_row]);
}

void FrameReader::read_light(const Radiance& radiance, std::vector<float>& rgb) {
    auto light =
        std::find_if(lights_.begin(), lights_.end(), [&](const Light& l) { return l.rgb == &rgb; });
    if (light == lights_.end()) light = lights_.insert(light, Light{});
    const View& view = radiance.view;
    light->view = view;
    light->rgb = &rgb;
    light->planes.resize(std::size_t{3} * view.stride * view.height);
    gpu_.queue.enqueueReadBuffer(radiance.planes, CL_FALSE, 0, light->planes.size() * sizeof(float),
                                 light->planes.data());
}

void FrameReader::finish() {
    gpu_.queue.finish();
    for (const Light& light : lights_) {
        const View& view = light.view;
        const std::size_t plane = std::size_t{view.stride} * view.height;
        float* out = &(*light.rgb)[std::size_t{3} * view.width * view.first_row];
        for (std::size_t y = 0; y < view.height; ++y) {
            const float* row = &light.planes[y * view.stride];
            for (std::size_t x = 0; x < view.width; ++x) {
                for (std::size_t c = 0; c < 3; ++c) *out++ = row[c * plane + x];
            }
        }
    }
    lights_.clear();
}

}  // namespace kilolux
