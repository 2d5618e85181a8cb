// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

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
    /// `Member` returns the address of the member of PictureErrors that holds the metric.
    template <typename Member>
    constexpr ErrorMetric(std::string_view metric_name, std::string_view column_name,
                          std::string_view text, MetricPart of, bool errs, Member)
        : name(metric_name),
          column(column_name),
          meaning(text),
          part(of),
          is_error(errs),
          value([](const PictureErrors& errors) { return number_of(*Member()(errors)); }),
          take([](PictureErrors& errors, double number) {
              auto& member = *Member()(errors);
              member = static_cast<std::remove_cvref_t<decltype(member)>>(number);
          }) {}

    std::string_view name;     // of options
    std::string_view column;   // of tables, with its unit
    std::string_view meaning;  // in a line
    MetricPart part;
    // 0 for equal pictures, and grows with the error: thresholds and budgets take it.
    bool is_error;
    std::optional<double> (*value)(const PictureErrors& errors);
    void (*take)(PictureErrors& errors, double number);  // sets what value() returns

 private:
    static std::optional<double> number_of(double value) { return value; }
    static std::optional<double> number_of(std::uint64_t count) {
        return static_cast<double>(count);
    }
    static std::optional<double> number_of(const std::optional<double>& value) { return value; }
};

std::span<const ErrorMetric> error_metrics();

}  // namespace kilolux
