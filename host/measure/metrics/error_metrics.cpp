// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/error_metrics.h"

namespace kilolux {
namespace {

using enum MetricPart;

constexpr ErrorMetric kMetrics[] = {
    {"rmse", "rmse", "root of the mean square difference", hdr, true,
     [](auto& e) { return &e.hdr.rmse; }},
    {"mean", "mean abs", "mean absolute difference", hdr, true,
     [](auto& e) { return &e.hdr.absolute.mean; }},
    {"max", "max abs", "largest absolute difference", hdr, true,
     [](auto& e) { return &e.hdr.absolute.max; }},
    {"most", "99.9 % abs", "99.9th percentile of the absolute difference", hdr, true,
     [](auto& e) { return &e.hdr.absolute.percentile_99_9; }},
    {"max-relative", "max rel", "largest difference relative to the reference", hdr, true,
     [](auto& e) { return &e.hdr.relative.max; }},
    {"most-relative", "99.9 % rel", "99.9th percentile of the relative difference", hdr, true,
     [](auto& e) { return &e.hdr.relative.percentile_99_9; }},
    {"relmse", "relmse", "mean of relative squares", hdr, true,
     [](auto& e) { return &e.hdr.rel_mse; }},
    {"different-pixels", "bit-different pixels", "pixels that differ in any bit", hdr, true,
     [](auto& e) { return &e.hdr.different_pixels; }},
    {"psnr", "psnr [dB]", "peak over RMSE", hdr, false, [](auto& e) { return &e.hdr.psnr_db; }},
    {"psnr-peak", "psnr peak", "the peak of PSNR", hdr, false,
     [](auto& e) { return &e.hdr.psnr_peak; }},
    {"nan-pixels", "nan pixels", "pixels with a NaN", hdr, false,
     [](auto& e) { return &e.hdr.nan_pixels; }},
    {"infinite-pixels", "infinite pixels", "pixels with an infinite value", hdr, false,
     [](auto& e) { return &e.hdr.infinite_pixels; }},
    {"negative-pixels", "negative pixels", "pixels with a value below 0", hdr, false,
     [](auto& e) { return &e.hdr.negative_pixels; }},
    {"flip", "flip mean", "mean difference that an observer sees, 0 to 1 (FLIP)", flip, true,
     [](auto& e) { return &e.flip.mean; }},
    {"most-flip", "flip 99.9 %", "99.9th percentile of FLIP", flip, true,
     [](auto& e) { return &e.flip.percentile_99_9; }},
    {"ldr-flip", "ldr-flip mean", "mean FLIP of the display pictures", display, true,
     [](auto& e) { return &e.flip_display.mean; }},
    {"codes", "max codes", "largest difference of 8-bit codes", display, true,
     [](auto& e) { return &e.codes.difference.max; }},
    {"different-codes", "code-different pixels", "pixels that differ in an 8-bit code", display,
     true, [](auto& e) { return &e.codes.different_pixels; }},
    {"ssim", "ssim", "structural similarity", display, false, [](auto& e) { return &e.ssim; }},
};

}  // namespace

std::span<const ErrorMetric> error_metrics() { return kMetrics; }

}  // namespace kilolux
