// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/measure/metrics/rgb_image.h"
#include "host/picture/frame.h"
#include "host/picture/view_canvas.h"

namespace kilolux {

/// The difference of a picture from its reference.
struct Comparison {
    std::string metric;
    double value = 0.0;      // of `metric`
    double threshold = 0.0;  // largest value that passes
    std::vector<std::pair<std::string, double>>
        errors;  // by name; FLIP, which is slow, if asked for
    bool passed() const { return value <= threshold; }
};

/// A picture to compare frames with. Linear files are compared with Frame::radiance, the others
/// with Frame::display as values 0..1.
class Reference {
 public:
    /// Reads the file. Throws UsageError for an unknown type, Error if it cannot be read.
    explicit Reference(std::filesystem::path file);

    /// `metric`: an error of error_metrics() of linear pictures or of FLIP. Throws Error when the
    /// sizes differ.
    Comparison compare(const Frame& frame, const std::string& metric, double threshold) const;

    /// The relative error |picture - reference| / |reference| of each pixel's worst channel.
    Canvas error_map(const Frame& frame) const;

    /// The difference as a picture: Frame::radiance is |picture - reference| of each channel,
    /// Frame::display a heat map of each pixel's largest, logarithmic from 1e-6 to 1.
    Frame difference(const Frame& frame) const;

 private:
    RgbImage comparable(const Frame& frame) const;

    std::filesystem::path file_;
    bool linear_ = true;
    RgbImage colour_;
};

/// Relative errors in the heat map's colours, logarithmic from 1e-8 to 1, with its legend: one
/// value a pixel of a `from_width` x `from_height` picture, magnified to `width` x `height`.
struct ErrorMapSize {
    int from_width, from_height, width, height;
};
Canvas error_map(std::span<const double> relative, const ErrorMapSize& size);

/// Throws Error unless the picture in `file` is of that size; reads its header only.
void require_reference_size(const std::filesystem::path& file, int width, int height);

}  // namespace kilolux
