// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "host/render/frame.h"

namespace kilolux {

/// Errors that --metric knows; each is 0 for equal pictures and larger for worse ones.
std::vector<std::string> metric_names();

/// How far a picture is from its reference.
struct Comparison {
    std::string metric;
    double value = 0.0;                                  // of `metric`
    double threshold = 0.0;                              // largest value that passes
    std::vector<std::pair<std::string, double>> errors;  // of every metric, by name
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
    int width_ = 0;
    int height_ = 0;
    bool linear_ = true;
    std::vector<float> colour_;  // 3 * width * height
};

}  // namespace kilolux
