// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "host/render/renderer.h"
#include "present/window/app/window.h"

namespace kilolux {

/// A picture to render, and where to.
struct PictureRequest {
    std::uint64_t serial = 0;  // which state of the window it shows
    RenderSettings settings;
    Camera camera;
    double time = 0.0;     // [s]
    std::size_t slot = 0;  // of PictureBuffers
    std::span<uint> pixels;
};

/// A rendered one.
struct Picture {
    PictureRequest request;
    Frame frame;  // without display and radiance
    DeviceInfo device;
    ScenePlan plan;
    std::uint64_t device_bytes = 0;  // of our OpenCL buffers
};

/// The Renderer in a thread of its own, so that the window answers while a picture takes its time,
/// and draws one picture while the next is made.
///
/// It renders what request() asked for last, and between pictures does what post() gave it. Calls
/// wake_windows() whenever there is something new to take.
class RenderWorker {
 public:
    using Job = std::function<void(Renderer&)>;

    /// `context`: a window of its own for the thread's OpenGL. Scene and context must outlive this.
    RenderWorker(const Scene& scene, const RenderSettings& settings, const Window& context);
    ~RenderWorker();
    RenderWorker(const RenderWorker&) = delete;
    RenderWorker& operator=(const RenderWorker&) = delete;

    /// Asks for a picture instead of the last one asked for, if that has not been begun: then
    /// returns its slot.
    std::optional<std::size_t> request(PictureRequest request);

    /// Has `job` done before the next picture. What it throws becomes take_error()'s.
    void post(Job job);

    std::optional<Picture> take_picture();

    /// A request or job that failed, in one line; its picture's slot, if it had one, is free.
    struct Failure {
        std::string what;
        std::optional<std::size_t> slot;
        std::uint64_t serial = 0;  // of the request; 0: a job
    };
    std::optional<Failure> take_failure();

    /// Throws what kept the renderer from being made.
    void check_alive() const;

    /// Neither a picture nor a job is asked for or being worked on.
    bool is_idle() const;

    /// Asked by jobs that take long: the window closes.
    bool is_stopping() const { return stopping_; }

 private:
    void run();
    void work(Renderer& renderer);
    void do_job(Renderer& renderer, const Job& job);
    void do_picture(Renderer& renderer, PictureRequest request);
    void fail(const std::string& what, const PictureRequest* request);

    const Scene& scene_;
    RenderSettings first_settings_;
    const Window& context_;
    mutable std::mutex mutex_;  // guards all below but the thread
    std::condition_variable changed_;
    std::optional<PictureRequest> request_;
    std::deque<Job> jobs_;
    std::deque<Picture> pictures_;
    std::deque<Failure> failures_;
    std::exception_ptr fatal_;
    bool working_ = true;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace kilolux
