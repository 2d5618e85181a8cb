// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace kilolux {

/// Summary of repeated measurements.
struct Statistics {
    std::size_t count = 0;
    double min = 0.0;
    double p5 = 0.0;
    double median = 0.0;
    double p95 = 0.0;
    double max = 0.0;
    double mean = 0.0;
};

/// Of any number of values in any order; all 0 without values. Percentiles between two values are
/// interpolated linearly (Hyndman and Fan 1996, definition 7). A NaN makes all but the count NaN.
Statistics statistics(std::span<const double> values);

/// a / b; 0 where b is not above 0, which marks values that were not measured.
inline double ratio_of(double a, double b) { return b > 0.0 ? a / b : 0.0; }

/// The value below which `share` (0..1) of the ascending, not empty `sorted` lie; interpolated.
double quantile(std::span<const double> sorted, double share);

/// Half the width of the notch of the ascending, not empty `sorted`: medians whose notches do not
/// overlap differ with 95 % confidence (McGill, Tukey and Larsen 1978, "Variations of Box Plots").
double notch(std::span<const double> sorted);

/// Whether a true value lies within the 95 % interval about an estimate of that variance, whose
/// error is normal. Without a variance it must equal the estimate.
bool is_within(double estimate, double variance, double truth);

}  // namespace kilolux
