// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/error_measurement.h"

#include <utility>

#include "host/base/error.h"
#include "present/image/comparison.h"
#include "present/window/app/picture_queue.h"

namespace kilolux {

void ErrorMeasurement::begin(RenderWorker& worker, const PictureRequest& request,
                             const std::function<void()>& wake) {
    if (is_open()) return;
    request_ = request;
    share_ = 0.0f;
    measuring_ = Awaited(worker.ask([this, request, wake, &worker](Renderer& renderer) {
        const auto progress = [&](double share) {
            if (worker.is_stopping()) throw Interrupted();
            share_ = static_cast<float>(share);
            wake();
        };
        return measure_frame_error(renderer, request.settings, request.camera, request.time,
                                   progress);
    }));
}

bool ErrorMeasurement::take(const OnFailure& failed) {
    bool is_new = false;
    measuring_.take(
        [&](FrameError error) {
            const RenderSettings& s = request_->settings;
            const Canvas canvas =
                error_map(error.relative, {error.width, error.height, s.width, s.height});
            map_ = make_texture(GL_TEXTURE_2D);
            glTextureStorage2D(map_.name(), 1, GL_RGBA8, canvas.width, canvas.height);
            glTextureParameteri(map_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
            glTextureSubImage2D(map_.name(), 0, 0, 0, canvas.width, canvas.height, GL_RGBA,
                                GL_UNSIGNED_BYTE, canvas.rgba.data());
            error_ = std::move(error);
            is_new = true;
        },
        failed);
    return is_new;
}

GLuint ErrorMeasurement::map_of(const PictureRequest& wanted) const {
    return error_ && same_content(*request_, wanted) ? map_.name() : 0;
}

}  // namespace kilolux
