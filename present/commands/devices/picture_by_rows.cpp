// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/picture_by_rows.h"

#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "host/picture/frame_bands.h"
#include "present/commands/devices/shared_rows.h"
#include "present/commands/devices/shared_tasks.h"

namespace kilolux {
// A picture of the scene: the one that is asked for, or the one before a white background.
struct Pass {
    Pass(const RenderSettings& wanted, int least_rows, std::size_t devices)
        : settings(wanted), rows(wanted.height, least_rows, devices) {}

    RenderSettings settings;  // but for the device
    SharedRows rows;
    std::once_flag begun;
    std::unique_ptr<SharedPicture> picture{};
};

// What the devices share.
struct RowsJob {
    const Camera camera;
    const double time;
    std::deque<Pass> passes{};       // one after the other
    SharedTasks finishing{0, 1, 1};  // what needs all rows, once
    FrameStats finished{};

    void fail(std::exception_ptr failure) {
        finishing.fail(std::move(failure));
        for (Pass& pass : passes) pass.rows.stop();
    }
};

namespace {

void take_settings(Renderer& renderer, RenderSettings settings) {
    settings.device = renderer.settings().device;
    settings.opened = renderer.settings().opened;
    renderer.change(settings);
}

void count_rows(DeviceShare& share, Band rows, const FrameStats& stats) {
    if (share.rows == 0) {
        share.stats = stats;
    } else {
        add_rows(share.stats, stats);
    }
    share.rows += rows.rows;
}

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

// A device's part: rows of each pass until there are none, and the end of the picture, which one of
// them makes. Throws where the device fails.
void work(RowsJob& job, Renderer& renderer, std::size_t device, DeviceShare& share) {
    for (Pass& pass : job.passes) make_rows(job, pass, renderer, device, share);
    if (!job.finishing.take()) return;
    try {
        Pass& pass = job.passes.front();
        take_settings(renderer, pass.settings);
        job.finished = renderer.finish_rows(*pass.picture, job.camera, job.time);
    } catch (...) {
        job.finishing.give_back(0);
        throw;
    }
    job.finishing.deliver(0, [] {});
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

bool has_rows_to_share(const Scene& scene, const RenderSettings& settings) {
    return !is_forward(settings.renderer) && !has_blended_surfaces(scene);
}

RowHelpers::RowHelpers(const std::vector<std::string>& devices)
    : shares_(1), left_(1 + devices.size()) {
    for (DeviceShare& share : shares_of(devices)) shares_.push_back(std::move(share));
}

RowHelpers::~RowHelpers() {
    {
        const std::scoped_lock lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
}

void RowHelpers::start(const Scene& scene, const RenderSettings& settings) {
    getting_ready_ = shares_.size() - 1;
    for (std::size_t i = 1; i < shares_.size(); ++i) {
        threads_.emplace_back([this, i, &scene, settings] {
            bool is_ready = false;
            run_guarded(i, [&] {
                RenderSettings own = settings;
                own.device = shares_[i].index;
                own.opened.reset();
                Renderer renderer(scene, own);
                is_ready = true;
                if (RowsJob* job = wait_for_job()) work(*job, renderer, i, shares_[i]);
            });
            if (!is_ready) count_ready();
        });
    }
}

void RowHelpers::run_guarded(std::size_t device, const std::function<void()>& run) noexcept {
    run_share(
        shares_[device], left_, [this](std::exception_ptr e) { fail(std::move(e)); }, run);
}

void RowHelpers::fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (job_ != nullptr) return job_->fail(std::move(failure));
    if (!failure_) failure_ = std::move(failure);
}

void RowHelpers::count_ready() {
    const std::scoped_lock lock(mutex_);
    --getting_ready_;
    changed_.notify_all();
}

// Null: there is none.
RowsJob* RowHelpers::wait_for_job() {
    count_ready();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over_ || job_ != nullptr; });
    return job_;
}

void RowHelpers::wait_until_ready() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return getting_ready_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
}

void RowHelpers::begin(RowsJob& job) {
    const std::scoped_lock lock(mutex_);
    job_ = &job;
    changed_.notify_all();
}

PictureByRows RowHelpers::render(SceneRenderer& pictures, bool has_alpha, double time, int frame) {
    pictures.place(time, frame);
    const RenderSettings settings = pictures.renderer().settings();
    shares_[0] = shares_of({settings.device}).front();
    RowsJob job{pictures.camera(), time};
    const int least = pictures.renderer().memory().least_rows;
    job.passes.emplace_back(settings, least, shares_.size());
    if (has_alpha) job.passes.emplace_back(before_white(settings), least, shares_.size());
    begin(job);
    run_guarded(0, [&] { work(job, pictures.renderer(), 0, shares_[0]); });
    threads_.clear();  // waits for them
    job.finishing.rethrow();
    if (shares_[0].failure.empty()) pictures.renderer().change(settings);
    PictureByRows out{std::move(job.passes.front().picture->frame), {}, std::move(shares_)};
    out.frame.stats = stats_of(job, out.frame.stats, out.shares);
    if (has_alpha) out.alpha = coverage_of(out.frame, job.passes.back().picture->frame);
    return out;
}

}  // namespace kilolux
