// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "host/picture/bands.h"

namespace kilolux {

/// The rows of a picture, which several devices make at once. A free device takes the next rows:
/// first one of `parts` equal parts of what an equally fast device would make, later half of its
/// share of the remaining rows. Shares follow the measured speeds, so that all devices end
/// together. Any thread may call all functions.
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
