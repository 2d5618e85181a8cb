// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/picture_by_rows.h"

#include <deque>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "host/picture/frame_bands.h"
#include "present/commands/devices/shared_rows.h"
#include "present/commands/devices/shared_tasks.h"

namespace kilolux {
namespace {

// A picture of the scene: the one that is asked for, or the one before a white background.
struct Pass {
    Pass(const RenderSettings& wanted, int least_rows, const std::vector<DeviceInfo>& devices)
        : settings(wanted), rows(wanted.height, least_rows, devices.size(), parts_for(devices)) {}

    RenderSettings settings;  // but for the device
    SharedRows rows;
    std::once_flag begun;
    std::unique_ptr<SharedPicture> picture{};
};

// What the devices share.
struct RowsJob : DeviceJob {
    RowsJob(const Camera& seen_by, double at) : camera(seen_by), time(at) {}

    void work(Renderer& renderer, std::size_t device, DeviceShare& share) override;

    void fail(std::exception_ptr failure) override {
        finishing.fail(std::move(failure));
        for (Pass& pass : passes) pass.rows.stop();
    }

    void rethrow() override { finishing.rethrow(); }

    const Camera camera;
    const double time;
    std::deque<Pass> passes{};       // one after the other
    SharedTasks finishing{0, 1, 1};  // what needs all rows, once
    FrameStats finished{};
};

void make_rows(const RowsJob& job, Pass& pass, Renderer& renderer, std::size_t device,
               DeviceShare& share) {
    take_settings(renderer, pass.settings);
    std::call_once(pass.begun, [&] { pass.picture = renderer.begin_rows(); });
    while (const std::optional<Band> rows = pass.rows.take(device)) {
        try {
            const FrameStats stats =
                renderer.render_rows(*pass.picture, job.camera, job.time, *rows);
            if (&pass == &job.passes.front()) count_rows(share, *rows, stats);
            pass.rows.finish(device, *rows, stats.frame_ms);
        } catch (...) {
            pass.rows.give_back(*rows);
            throw;
        }
    }
}

// Rows of each pass until there are none, and the end of the picture, which one of the devices
// makes.
void RowsJob::work(Renderer& renderer, std::size_t device, DeviceShare& share) {
    for (Pass& pass : passes) make_rows(*this, pass, renderer, device, share);
    if (!finishing.take()) return;
    try {
        Pass& pass = passes.front();
        take_settings(renderer, pass.settings);
        finished = renderer.finish_rows(*pass.picture, camera, time);
    } catch (...) {
        finishing.give_back(0);
        throw;
    }
    finishing.deliver(0, [] {});
}

// Adds times that no device shares.
void add_times_of(const FrameStats& part, FrameStats& stats) {
    for (const StageTime& stage : part.stages) add_stage_time(stats.stages, stage.name, stage.ms);
    stats.frame_ms += part.frame_ms;
    stats.build_ms += part.build_ms;
}

// `begun`: what it took to begin the picture.
FrameStats stats_of(const RowsJob& job, const FrameStats& begun,
                    const std::vector<DeviceShare>& shares) {
    std::vector<FrameStats> parts;
    for (const DeviceShare& share : shares) {
        if (share.rows > 0) parts.push_back(share.stats);
    }
    FrameStats out = joined(parts);
    add_times_of(begun, out);
    add_times_of(job.finished, out);
    return out;
}

}  // namespace

bool has_rows_to_share(const RenderSettings& settings) { return !is_forward(settings.renderer); }

PictureByRows render_by_rows(DeviceHelpers& helpers, SceneRenderer& pictures, bool has_alpha,
                             double time, int frame) {
    pictures.place(time, frame);
    const RenderSettings settings = pictures.renderer().settings();
    RowsJob job(pictures.camera(), time);
    const int least = pictures.renderer().memory().least_rows;
    std::vector<DeviceInfo> devices{pictures.renderer().device()};
    for (std::size_t i = 1; i < helpers.shares().size(); ++i) {
        devices.push_back(helpers.shares()[i].info);
    }
    job.passes.emplace_back(settings, least, devices);
    if (has_alpha) job.passes.emplace_back(before_white(settings), least, devices);
    std::vector<DeviceShare> shares = helpers.run(job, pictures.renderer());
    PictureByRows out{std::move(job.passes.front().picture->frame), {}, std::move(shares)};
    out.frame.stats = stats_of(job, out.frame.stats, out.shares);
    if (has_alpha) out.alpha = coverage_of(out.frame, job.passes.back().picture->frame);
    return out;
}

}  // namespace kilolux
