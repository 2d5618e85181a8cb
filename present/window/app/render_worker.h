// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <span>
#include <string>

#include "host/base/system/interrupt.h"
#include "host/render/renderer.h"
#include "present/window/app/task_thread.h"

namespace kilolux {

/// The progress of a picture. The window reads it, and may cancel the picture, while it is made.
class PictureProgress {
 public:
    void give_up() { given_up_ = true; }
    /// Since the picture was begun [s]; 0 before.
    double seconds() const;
    /// About how long the whole picture takes [s]; 0 while that is unknown.
    double estimate() const { return estimate_; }

    /// Called by the worker when the picture is begun, and with the finished share. Throws
    /// Interrupted once the picture is cancelled.
    void begin();
    void note(double share);

 private:
    static double now();

    std::atomic<bool> given_up_ = false;
    std::atomic<double> began_ = 0.0;     // [s] of a steady clock; 0: not yet
    std::atomic<double> estimate_ = 0.0;  // [s]
    // The end of the first part, which also compiles.
    double first_share_ = 0.0;
    double first_end_ = 0.0;  // [s] of the clock
};

/// A picture to render, and its memory.
struct PictureRequest {
    RenderSettings settings;
    Camera camera;
    double time = 0.0;                               // [s]
    std::span<uint> pixels;                          // rows display_stride() apart
    int samples = 0;                                 // of settings.samples; 0: all
    std::uint32_t lights = 0;                        // their version, SceneLights::version()
    std::shared_ptr<PictureProgress> progress = {};  // null: not needed
};

/// The line about a picture that takes longer than two seconds; empty: it does not. `whole_s`:
/// about how long it takes, 0 while that is unknown.
std::string waiting_text(RendererKind renderer, double so_far_s, double whole_s);

/// A rendered picture without its pixels.
struct Picture {
    Frame frame;  // without display and radiance
    DeviceInfo device;
    ScenePlan plan;
    std::uint64_t device_bytes = 0;  // of our OpenCL buffers
};

/// The Renderer in its own thread: the window responds while a picture is made, and shows one
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

    /// Runs work(renderer) before the next picture. At stop() it ends with Interrupted, unless it
    /// must finish.
    template <typename Work>
    auto ask(Work work, AtStop at_stop = AtStop::drop) {
        const bool may_end = at_stop == AtStop::drop;
        return thread_.ask(
            [this, may_end, work = std::move(work)] {
                const WorkWatch watch([this, may_end](double) { end_at_stop(may_end); });
                return work(*renderer_);
            },
            at_stop);
    }

    /// Throws the error that prevented the renderer.
    void check_begun() const { thread_.check_begun(); }
    bool is_stopping() const { return thread_.is_stopping(); }
    bool stop(std::chrono::milliseconds patience) { return thread_.stop(patience); }

 private:
    void end_at_stop(bool may_end) const;

    std::unique_ptr<Renderer> renderer_;  // used in the thread only
    TaskThread thread_;                   // last: it ends first
};

}  // namespace kilolux
