// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "host/measure/metrics/metrics.h"

namespace kilolux {

/// Every error of one picture against one reference.
struct PictureErrors {
    HdrMetrics hdr;
    CodeDifferences codes;
    std::optional<double> ssim;      // none of pictures smaller than its window
    ErrorDistribution flip;          // HDR-FLIP of the linear pictures
    ErrorDistribution flip_display;  // LDR-FLIP of the display pictures
};

/// The part of PictureErrors that holds a metric. `flip` is slow.
enum class MetricPart { hdr, display, flip };

/// A metric. The tables of reports and `--error-metric` are loops over error_metrics(); `render
/// --metric` takes those of hdr and flip, Python's compare() those of hdr.
struct ErrorMetric {
    std::string_view name;     // of options
    std::string_view column;   // of tables, with its unit
    std::string_view meaning;  // in a line
    MetricPart part;
    bool
        is_error;  // 0 for equal pictures, and grows with the error: thresholds and budgets take it
    std::optional<double> (*value)(const PictureErrors& errors);
};

std::span<const ErrorMetric> error_metrics();

}  // namespace kilolux
