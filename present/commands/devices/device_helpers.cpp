// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/device_helpers.h"

#include <memory>
#include <utility>

#include "host/picture/frame_bands.h"

namespace kilolux {

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

DeviceHelpers::DeviceHelpers(const std::vector<std::string>& devices)
    : shares_(1), left_(1 + devices.size()) {
    for (DeviceShare& share : shares_of(devices)) shares_.push_back(std::move(share));
}

DeviceHelpers::~DeviceHelpers() {
    {
        const std::scoped_lock lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
}

void DeviceHelpers::start(const Scene& scene, const RenderSettings& settings) {
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
                if (DeviceJob* job = wait_for_job()) job->work(renderer, i, shares_[i]);
            });
            if (!is_ready) count_ready();
        });
    }
}

void DeviceHelpers::run_guarded(std::size_t device, const std::function<void()>& run) noexcept {
    run_share(
        shares_[device], left_, [this](std::exception_ptr e) { fail(std::move(e)); }, run);
}

void DeviceHelpers::fail(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    if (job_ != nullptr) return job_->fail(std::move(failure));
    if (!failure_) failure_ = std::move(failure);
}

void DeviceHelpers::count_ready() {
    const std::scoped_lock lock(mutex_);
    --getting_ready_;
    changed_.notify_all();
}

// Null: there is none.
DeviceJob* DeviceHelpers::wait_for_job() {
    count_ready();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over_ || job_ != nullptr; });
    return job_;
}

void DeviceHelpers::wait_until_ready() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return getting_ready_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
}

void DeviceHelpers::begin(DeviceJob& job) {
    const std::scoped_lock lock(mutex_);
    job_ = &job;
    changed_.notify_all();
}

std::vector<DeviceShare> DeviceHelpers::run(DeviceJob& job, Renderer& renderer) {
    const RenderSettings settings = renderer.settings();
    shares_[0] = shares_of({settings.device}).front();
    begin(job);
    run_guarded(0, [&] { job.work(renderer, 0, shares_[0]); });
    threads_.clear();  // waits for them
    job.rethrow();
    if (shares_[0].failure.empty()) renderer.change(settings);
    return std::move(shares_);
}

}  // namespace kilolux
