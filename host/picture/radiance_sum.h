// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"

namespace kilolux {

/// Mean of pictures, summed in float64.
class RadianceSum {
 public:
    explicit RadianceSum(const Gpu& gpu) : gpu_(gpu), mean_(gpu, "samples") {}

    /// Forgets all pictures.
    void clear();

    /// Adds a picture; all must have the same size. Blocks.
    void add(const Radiance& radiance);

    /// The mean, rounded to float32 once; on the device until the next call. At least one was
    /// added.
    Radiance mean();

 private:
    Gpu gpu_;
    std::vector<double> sums_;
    int count_ = 0;
    View view_{};
    GrowingBuffer mean_;
};

}  // namespace kilolux
