// SPDX-License-Identifier: Apache-2.0
#include "present/commands/devices/shared_rows.h"

#include <algorithm>
#include <cmath>

namespace kilolux {

int parts_for(const std::vector<DeviceInfo>& devices) {
    const bool are_equal_gpus = std::ranges::all_of(devices, [&](const DeviceInfo& device) {
        return !device.is_cpu && device.name == devices.front().name;
    });
    return are_equal_gpus ? 1 : 16;
}

SharedRows::SharedRows(int height, int least, std::size_t devices, int parts)
    : height_(height), step_(least), parts_(parts), speeds_(devices) {}

std::optional<Band> SharedRows::take(std::size_t device) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
        return is_stopped_ || made_ == height_ || !returned_.empty() || next_ < height_;
    });
    if (is_stopped_ || made_ == height_) return std::nullopt;
    if (!returned_.empty()) {
        const Band rows = returned_.back();
        returned_.pop_back();
        return rows;
    }
    const Band rows{next_, std::min(rows_for(device), height_ - next_)};
    next_ += rows.rows;
    return rows;
}

// A device that is not measured counts as the mean of those that are.
int SharedRows::rows_for(std::size_t device) const {
    const auto devices = static_cast<double>(speeds_.size());
    double rows = height_ / (parts_ * devices);
    double sum = 0.0, measured = 0.0;
    for (const double speed : speeds_) {
        sum += speed;
        measured += speed > 0.0 ? 1.0 : 0.0;
    }
    if (speeds_[device] > 0.0) {
        const double share = speeds_[device] / (sum * devices / measured);
        rows = std::max(rows, 0.5 * share * (height_ - next_));
    }
    return static_cast<int>(std::ceil(rows / step_)) * step_;
}

void SharedRows::finish(std::size_t device, Band rows, double ms) {
    const std::scoped_lock lock(mutex_);
    made_ += rows.rows;
    if (ms > 0.0) speeds_[device] = rows.rows / ms;
    changed_.notify_all();
}

void SharedRows::give_back(Band rows) {
    const std::scoped_lock lock(mutex_);
    returned_.push_back(rows);
    changed_.notify_all();
}

void SharedRows::stop() {
    const std::scoped_lock lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
}

}  // namespace kilolux
