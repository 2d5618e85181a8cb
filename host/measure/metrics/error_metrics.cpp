// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/error_metrics.h"

namespace kilolux {
namespace {

using Errors = PictureErrors;
using enum MetricPart;

double number(std::uint64_t count) { return static_cast<double>(count); }

constexpr ErrorMetric kMetrics[] = {
    {"rmse", "rmse", "root of the mean square difference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.rmse); }},
    {"mean", "mean abs", "mean absolute difference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.absolute.mean); }},
    {"max", "max abs", "largest absolute difference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.absolute.max); }},
    {"most", "99.9 % abs", "99.9th percentile of the absolute difference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.absolute.percentile_99_9); }},
    {"max-relative", "max rel", "largest difference relative to the reference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.relative.max); }},
    {"most-relative", "99.9 % rel", "99.9th percentile of the relative difference", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.relative.percentile_99_9); }},
    {"relmse", "relmse", "mean of relative squares", hdr, true,
     [](const Errors& e) { return std::optional(e.hdr.rel_mse); }},
    {"different-pixels", "bit-different pixels", "pixels that differ in any bit", hdr, true,
     [](const Errors& e) { return std::optional(number(e.hdr.different_pixels)); }},
    {"psnr", "psnr [dB]", "peak over RMSE", hdr, false,
     [](const Errors& e) { return std::optional(e.hdr.psnr_db); }},
    {"psnr-peak", "psnr peak", "the peak of PSNR", hdr, false,
     [](const Errors& e) { return std::optional(e.hdr.psnr_peak); }},
    {"nan-pixels", "nan pixels", "pixels with a NaN", hdr, false,
     [](const Errors& e) { return std::optional(number(e.hdr.nan_pixels)); }},
    {"infinite-pixels", "infinite pixels", "pixels with an infinite value", hdr, false,
     [](const Errors& e) { return std::optional(number(e.hdr.infinite_pixels)); }},
    {"negative-pixels", "negative pixels", "pixels with a value below 0", hdr, false,
     [](const Errors& e) { return std::optional(number(e.hdr.negative_pixels)); }},
    {"flip", "flip mean", "mean difference that an observer sees, 0 to 1 (FLIP)", flip, true,
     [](const Errors& e) { return std::optional(e.flip.mean); }},
    {"most-flip", "flip 99.9 %", "99.9th percentile of FLIP", flip, true,
     [](const Errors& e) { return std::optional(e.flip.percentile_99_9); }},
    {"ldr-flip", "ldr-flip mean", "mean FLIP of the display pictures", display, true,
     [](const Errors& e) { return std::optional(e.flip_display.mean); }},
    {"codes", "max codes", "largest difference of 8-bit codes", display, true,
     [](const Errors& e) { return std::optional(e.codes.difference.max); }},
    {"different-codes", "code-different pixels", "pixels that differ in an 8-bit code", display,
     true, [](const Errors& e) { return std::optional(number(e.codes.different_pixels)); }},
    {"ssim", "ssim", "structural similarity", display, false,
     [](const Errors& e) { return e.ssim; }},
};

}  // namespace

std::span<const ErrorMetric> error_metrics() { return kMetrics; }

}  // namespace kilolux
