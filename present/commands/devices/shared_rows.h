// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "host/gpu/device.h"
#include "host/picture/bands.h"

namespace kilolux {

/// SharedRows' `parts` for these devices. Threads that launch kernels on GPUs wait for each other
/// in the driver, which costs more than an uneven end: equal GPUs get 1, so each makes its share at
/// once. Sponza at 3840x2160, exact shadows, 256 samples: one H200 takes 2.0 s, two take 1.3 s with
/// 1 part, 2.3 s with 4 or 16.
int parts_for(const std::vector<DeviceInfo>& devices);

/// The rows of a picture, which several devices make at once. A free device takes the next rows:
/// first 1 / `parts` of an equal share of the rows, later half of its share of the rest. Shares
/// follow the measured speeds, so that all devices end together. Any thread may call all functions.
class SharedRows {
 public:
    /// `least`: rows are taken in multiples of it, see MemoryPlan::least_rows.
    SharedRows(int height, int least, std::size_t devices, int parts);

    /// The next rows for a device; waits while there are none, but another device may give some
    /// back. None: all are made, or stop() was called.
    std::optional<Band> take(std::size_t device);

    /// The device has made rows that it took, within `ms`.
    void finish(std::size_t device, Band rows, double ms);

    /// Another device is to make rows that were taken.
    void give_back(Band rows);

    /// No rows are taken any more.
    void stop();

 private:
    int rows_for(std::size_t device) const;

    const int height_, step_, parts_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int next_ = 0;  // first row that was not taken
    int made_ = 0;
    bool is_stopped_ = false;
    std::vector<double> speeds_;  // rows a millisecond; 0: not measured
    std::vector<Band> returned_;
};

}  // namespace kilolux
