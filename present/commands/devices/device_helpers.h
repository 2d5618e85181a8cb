// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "present/commands/devices/device_share.h"
#include "present/commands/scene_renderer.h"

namespace kilolux {

/// A picture that several devices make, each with a renderer of its own.
class DeviceJob {
 public:
    virtual ~DeviceJob() = default;

    /// A device's part, in its thread: [0] is the device that is helped. Throws where it fails;
    /// others make again what it had begun.
    virtual void work(Renderer& renderer, std::size_t device, DeviceShare& share) = 0;

    /// Ends the whole job; any thread calls it.
    virtual void fail(std::exception_ptr failure) = 0;

    /// Throws what the job failed with.
    virtual void rethrow() = 0;
};

/// Gives the renderer other settings, but for its device.
void take_settings(Renderer& renderer, RenderSettings settings);

/// Adds rows to what the device has done.
void count_rows(DeviceShare& share, Band rows, const FrameStats& stats);

/// The devices that help a renderer to make one picture, each with a renderer and a thread of its
/// own.
class DeviceHelpers {
 public:
    explicit DeviceHelpers(const std::vector<std::string>& devices);
    /// Waits for their threads.
    ~DeviceHelpers();
    DeviceHelpers(const DeviceHelpers&) = delete;
    DeviceHelpers& operator=(const DeviceHelpers&) = delete;

    /// The devices; [0] is the one that is helped, known from run() on.
    const std::vector<DeviceShare>& shares() const { return shares_; }

    /// Builds their renderers, in their threads. The scene must outlive this, and stay as it is
    /// until wait_until_ready() returns.
    void start(const Scene& scene, const RenderSettings& settings);

    /// Waits until each helper has its renderer, or has failed.
    void wait_until_ready();

    /// Does the job with the helpers and `renderer`, whose settings it gets back. Call it once,
    /// after wait_until_ready(). All devices begin together. A device that fails is left out;
    /// throws its error where none is left. Returns what each has done.
    std::vector<DeviceShare> run(DeviceJob& job, Renderer& renderer);

 private:
    void count_ready();
    DeviceJob* wait_for_job();
    void begin(DeviceJob& job);
    void run_guarded(std::size_t device, const std::function<void()>& run) noexcept;
    void fail(std::exception_ptr failure);

    std::vector<DeviceShare> shares_;  // [0]: the renderer that is helped
    std::atomic<std::size_t> left_;    // devices that have not failed
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t getting_ready_ = 0;  // helpers
    DeviceJob* job_ = nullptr;       // none yet
    bool is_over_ = false;
    std::exception_ptr failure_;  // before there was a job
    std::vector<std::jthread> threads_;
};

}  // namespace kilolux
