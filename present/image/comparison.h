// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/picture/frame.h"

namespace kilolux {

/// Errors that --metric knows; each is 0 for equal pictures and larger for worse ones. Of linear
/// files in their unit, of others in [0, 1]: `rmse`, `mean` and `max` of |x-r|; `max-relative`, the
/// largest |x-r| / |r|; `relmse`, relative squares; `different-pixels`, by any bit; `flip`, what an
/// observer notices on average (HDR-FLIP for linear files).
std::vector<std::string> metric_names();

/// How far a picture is from its reference.
struct Comparison {
    std::string metric;
    double value = 0.0;      // of `metric`
    double threshold = 0.0;  // largest value that passes
    std::vector<std::pair<std::string, double>>
        errors;  // by name; `flip`, which is slow, if asked for
    bool passed() const { return value <= threshold; }
};

/// A picture to compare frames with. Linear files are compared with Frame::radiance, the others
/// with Frame::display as values 0..1.
class Reference {
 public:
    /// Reads the file; throws UsageError for an unknown type, Error if it cannot be read.
    explicit Reference(std::filesystem::path file);

    /// Throws Error when the sizes differ.
    Comparison compare(const Frame& frame, const std::string& metric, double threshold) const;

 private:
    std::filesystem::path file_;
    bool linear_ = true;
    RgbImage colour_;
};

}  // namespace kilolux
