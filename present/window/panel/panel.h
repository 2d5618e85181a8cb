// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/reference/frame_error.h"
#include "host/measure/roofline/device_limits.h"
#include "host/measure/roofline/stage_report.h"
#include "host/render/scene_plan.h"
#include "host/scene/scene.h"
#include "present/window/app/bench_job.h"
#include "present/window/app/view_state.h"
#include "present/window/panel/stage_history.h"
#include "present/window/panel/widgets.h"

namespace kilolux {

/// What the panel says about the last picture and what made it.
struct PanelFacts {
    const Scene& scene;
    std::size_t triangles = 0;
    DeviceInfo device;
    ScenePlan plan;
    FrameStats stats;
    int width = 0;   // of the last picture [pixel]
    int height = 0;  // [pixel]
    double scale = 1.0;
    StageHistory history;
    std::optional<DeviceLimits> limits;
    std::string opengl;               // the window's renderer
    const char* picture_way = "";     // how pictures come to the window
    std::uint64_t device_bytes = 0;   // of our OpenCL buffers
    std::uint64_t process_bytes = 0;  // resident
    std::size_t boxes = 0;            // frozen clusters drawn
    std::string status;               // what is being worked on; empty: nothing
    std::string failure;              // the last one; empty: none
    std::string message;              // what was done last: a file saved, text copied
};

/// What a person asked for in this frame.
struct PanelWishes {
    std::optional<int> scene_camera;
    bool reset_camera = false;
    bool frame_scene = false;
    bool copy_camera = false;
    bool copy_command = false;
    bool save_png = false;
    bool save_exr = false;
    bool full_screen = false;
    bool help = false;
    bool reset_settings = false;
    bool dismiss_failure = false;
    bool start_bench = false;
    bool stop_bench = false;
    bool measure_error = false;
};

/// A measurement of the picture's error, shared by the thread that measures and the window.
struct ErrorProgress {
    std::mutex mutex;  // guards the result
    std::optional<FrameError> result;
    std::atomic<float> share = 0.0f;
    std::atomic<bool> running = true;
};

/// The sections of the panel, one function each; they change `state` and `wishes`.
struct Panel {
    Widgets& ui;
    ViewState& state;
    PanelWishes& wishes;
    const PanelFacts& facts;

    void picture() const;
    void lights() const;
    void clusters() const;
    void speed() const;
    void camera(const CameraRig& rig) const;
    void window() const;
    void error(const std::shared_ptr<ErrorProgress>& progress) const;
    void bench(const std::shared_ptr<BenchProgress>& progress) const;
    void device() const;
};

/// A name-value line.
void fact_line(const char* name, const std::string& value);

/// "12.3 k", "1.20 M"; "34.5 MiB".
std::string short_count(double value);
std::string byte_text(std::uint64_t bytes);

}  // namespace kilolux
