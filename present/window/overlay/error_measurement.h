// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "host/measure/reference/frame_error.h"
#include "present/window/app/awaited.h"
#include "present/window/app/render_worker.h"
#include "raster/gl_object.h"

namespace kilolux {

/// The errors of a picture against float64, and their map.
class ErrorMeasurement {
 public:
    /// Measures the request's picture in the worker. `wake` is called there after each step.
    void begin(RenderWorker& worker, const PictureRequest& request,
               const std::function<void()>& wake);

    /// Takes the errors once they are measured. Returns whether they are new.
    bool take(const OnFailure& failed);

    bool is_open() const { return measuring_.is_open(); }
    float share() const { return share_; }  // of the measurement, 0 to 1
    const std::optional<FrameError>& error() const { return error_; }

    /// The map's texture, if it is that of `wanted`; else 0.
    GLuint map_of(const PictureRequest& wanted) const;

 private:
    Awaited<FrameError> measuring_;
    std::optional<PictureRequest> request_;  // whose picture is or was measured
    std::optional<FrameError> error_;
    GlTexture map_;
    std::atomic<float> share_ = 0.0f;
};

}  // namespace kilolux
