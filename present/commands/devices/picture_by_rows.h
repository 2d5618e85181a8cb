// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "present/commands/devices/device_share.h"
#include "present/commands/scene_renderer.h"

namespace kilolux {

/// A picture that several devices have made.
struct PictureByRows {
    Frame frame;  // with the counts of all devices, and the times of the slowest one
    std::vector<float> alpha;
    std::vector<DeviceShare> shares;
};

/// Whether several devices can make one picture: not where OpenGL lights or blends surfaces, which
/// takes whole pictures.
bool has_rows_to_share(const Scene& scene, const RenderSettings& settings);

/// What several devices share of a picture.
struct RowsJob;

/// The devices that help a renderer to make one picture by rows, each with a renderer and a thread
/// of its own.
class RowHelpers {
 public:
    explicit RowHelpers(const std::vector<std::string>& devices);
    /// Waits for their threads.
    ~RowHelpers();
    RowHelpers(const RowHelpers&) = delete;
    RowHelpers& operator=(const RowHelpers&) = delete;

    /// Builds their renderers, in their threads. The scene must outlive this, and stay as it is
    /// until wait_until_ready() returns.
    void start(const Scene& scene, const RenderSettings& settings);

    /// Waits until each helper has its renderer, or has failed.
    void wait_until_ready();

    /// Makes the picture of SceneRenderer::render(), bit for bit; with `has_alpha` also its
    /// coverage(). Call it once, after wait_until_ready(). All devices begin together; a free
    /// device takes the next rows. A device that fails is left out, and others make its rows again.
    /// Throws its error where none is left.
    PictureByRows render(SceneRenderer& pictures, bool has_alpha, double time, int frame);

 private:
    void count_ready();
    RowsJob* wait_for_job();
    void begin(RowsJob& job);
    void run_guarded(std::size_t device, const std::function<void()>& run) noexcept;
    void fail(std::exception_ptr failure);

    std::vector<DeviceShare> shares_;  // [0]: the renderer that is helped
    std::atomic<std::size_t> left_;    // devices that have not failed
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t getting_ready_ = 0;  // helpers
    RowsJob* job_ = nullptr;         // none yet
    bool is_over_ = false;
    std::exception_ptr failure_;  // before there was a job
    std::vector<std::jthread> threads_;
};

}  // namespace kilolux
