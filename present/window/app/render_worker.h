// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <span>

#include "host/render/renderer.h"
#include "host/scene/lights/rig.h"
#include "present/window/app/task_thread.h"

namespace kilolux {

/// A picture to render, and where to.
struct PictureRequest {
    RenderSettings settings;
    Camera camera;
    double time = 0.0;       // [s]
    std::span<uint> pixels;  // rows display_stride() apart
    int samples = 0;         // of settings.samples, the rest to come; 0: all
    Rig rig{};               // whose lights the scene has
};

/// What came with a rendered picture.
struct Picture {
    Frame frame;  // without display and radiance
    DeviceInfo device;
    ScenePlan plan;
    std::uint64_t device_bytes = 0;  // of our OpenCL buffers
};

/// The Renderer in a thread of its own: the window answers while a picture is made, and shows one
/// picture while the next is made.
class RenderWorker {
 public:
    /// `use_context` makes an OpenGL context of its own current in the thread (true), or none
    /// (false); `wake` is called in the thread whenever a future has become ready. The scene must
    /// outlive this.
    RenderWorker(const Scene& scene, const RenderSettings& settings,
                 std::function<void(bool)> use_context, TaskThread::Call wake);

    /// Renders after all tasks. Replaces the last request that has not begun.
    std::future<Picture> render(PictureRequest request);

    /// Runs work(renderer) before the next picture.
    template <typename Work>
    auto ask(Work work, AtStop at_stop = AtStop::drop) {
        return thread_.ask([this, work = std::move(work)] { return work(*renderer_); }, at_stop);
    }

    /// Throws what kept the renderer from being made.
    void check_begun() const { thread_.check_begun(); }
    bool is_stopping() const { return thread_.is_stopping(); }
    bool stop(std::chrono::milliseconds patience) { return thread_.stop(patience); }

 private:
    std::unique_ptr<Renderer> renderer_;  // used in the thread only
    TaskThread thread_;                   // last: it ends first
};

}  // namespace kilolux
