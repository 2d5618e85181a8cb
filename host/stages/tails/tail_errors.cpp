// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tails/tail_errors.h"

namespace kilolux {
namespace {

constexpr std::size_t kMomentRows = 36;  // TAIL_ROWS of kernels/tails/tail_moments.h

Kernel kernel_of(const Gpu& gpu, const char* name, const BuildOptions& options) {
    return Kernel(gpu, build_program(gpu, name, options), kTailErrorsStage, name);
}

BuildOptions tail_options(const KernelFeatures& features) {
    return feature_options(features)
        .define("SHADOWS", features.shadows)
        .define("SAMPLED_SHADOWS", features.sampled_shadows)
        .define("HALF_LIGHT_COLORS", 0);
}

}  // namespace

TailErrors::TailErrors(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(tuning),
      features_(features),
      moment_rows_(gpu, kTailErrorsStage),
      bounds_(gpu, kTailErrorsStage),
      variances_(gpu, kTailErrorsStage) {}

DeviceArray<float> TailErrors::bound(const LitPixels& lit, const DeviceArray<Light>& own,
                                     const ClusterBoxes& boxes, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    if (!bound_) {
        moments_ = kernel_of(gpu_, "tail_moments", tail_options(features_));
        bound_ = kernel_of(gpu_.with_lanes(1), "tail_bound", tail_options(features_));
    }
    const DeviceArray<float> rows =
        moment_rows_.reserve(kMomentRows * lit.clusters.grid.cluster_count);
    moments_->enqueue(moments_->vector_items(boxes.grid.cluster_count, 1), timer, own, lit.lights,
                      boxes, lit.clusters.occupied, rows);
    DeviceArray<float> out = bounds_.reserve(std::size_t{3} * view.stride * view.height);
    bound_->enqueue(bound_->pixel_items(view, tuning_.shade_rows), timer, lit.gbuffer, boxes.grid,
                    rows, out);
    return out;
}

DeviceArray<float> TailErrors::tree_bound(const LitPixels& lit, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    if (!tree_bound_) {
        tree_bound_ = kernel_of(gpu_.with_lanes(1), "tree_bound", tail_options(features_));
    }
    DeviceArray<float> out = bounds_.reserve(std::size_t{3} * view.stride * view.height);
    tree_bound_->enqueue(tree_bound_->pixel_items(view, tuning_.shade_rows), timer, lit, out);
    return out;
}

DeviceArray<float> TailErrors::variance(const LitPixels& lit, const ShadowWords& shadows,
                                        const ShadowSamples& samples,
                                        const DeviceArray<float>& shadow_variance,
                                        StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    if (!variance_) variance_ = kernel_of(gpu_, "tail_variance", tail_options(features_));
    DeviceArray<float> out = variances_.reserve(pixels);
    if (features_.sampled_shadows) {
        gpu_.queue.enqueueCopyBuffer(shadow_variance, out, 0, 0, pixels * sizeof(float));
    } else {
        gpu_.queue.enqueueFillBuffer(out.buffer(), 0.0f, 0, pixels * sizeof(float));
    }
    variance_->enqueue(variance_->pixel_items(view, tuning_.shade_rows), timer, lit, shadows,
                       samples, out);
    return out;
}

}  // namespace kilolux
