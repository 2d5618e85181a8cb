// SPDX-License-Identifier: Apache-2.0
#include "host/stages/tails/tail_errors.h"

#include "host/base/srgb.h"

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
      srgb_(gpu, kTailErrorsStage),
      moment_rows_(gpu, kTailErrorsStage),
      bounds_(gpu, kTailErrorsStage),
      variances_(gpu, kTailErrorsStage) {
    const auto table = srgb_to_linear_table();
    upload<float>(gpu_, srgb_.reserve(table.size()), table);
}

DeviceArray<float> TailErrors::bound(const LitPixels& lit, const DeviceArray<Light>& own,
                                     const ClusterBoxes& boxes, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    if (!bound_) {
        moments_ = kernel_of(gpu_, "tail_moments", tail_options(features_));
        bound_ = kernel_of(gpu_.with_lanes(1), "tail_bound", tail_options(features_));
    }
    const DeviceArray<float> rows = moment_rows_.reserve(kMomentRows * lit.grid.cluster_count);
    const auto lanes = static_cast<std::size_t>(gpu_.info.lane_width);
    moments_->enqueue(items((lit.grid.cluster_count + lanes - 1) / lanes, 1), timer, own,
                      lit.lights.lights, lit.lights.count, lit.grid, boxes.columns, boxes.rows,
                      boxes.depths, lit.clusters.occupied, rows);
    const DeviceArray<float> out = bounds_.reserve(std::size_t{3} * view.stride * view.height);
    bound_->enqueue(pixel_items(view, 1, tuning_.shade_rows), timer, lit.gbuffer.bytes,
                    lit.gbuffer.layout, view, srgb_.get(), lit.grid, rows, out);
    return out;
}

DeviceArray<float> TailErrors::tree_bound(const LitPixels& lit, StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    if (!tree_bound_) {
        tree_bound_ = kernel_of(gpu_.with_lanes(1), "tree_bound", tail_options(features_));
    }
    const DeviceArray<float> out = bounds_.reserve(std::size_t{3} * view.stride * view.height);
    tree_bound_->enqueue(pixel_items(view, 1, tuning_.shade_rows), timer, lit.gbuffer.bytes,
                         lit.gbuffer.layout, view, srgb_.get(), lit.grid, lit.clusters.offsets,
                         lit.clusters.clusters, lit.clusters.capacity, lit.refined.lists,
                         lit.lights.lights, lit.lights.count, lit.lights.nodes, out);
    return out;
}

DeviceArray<float> TailErrors::variance(const LitPixels& lit, const ShadowWords& shadows,
                                        const ShadowSamples& samples,
                                        const DeviceArray<float>& shadow_variance,
                                        StageTimer& timer) {
    const View& view = lit.gbuffer.view;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    if (!variance_) variance_ = kernel_of(gpu_, "tail_variance", tail_options(features_));
    const DeviceArray<float> out = variances_.reserve(pixels);
    if (features_.sampled_shadows) {
        gpu_.queue.enqueueCopyBuffer(shadow_variance, out, 0, 0, pixels * sizeof(float));
    } else {
        gpu_.queue.enqueueFillBuffer(out.buffer(), 0.0f, 0, pixels * sizeof(float));
    }
    const auto enqueue = [&](const auto&... rest) {
        variance_->enqueue(pixel_items(view, gpu_.info.lane_width, tuning_.shade_rows), timer,
                           lit.gbuffer.bytes, lit.gbuffer.layout, view, srgb_.get(),
                           lit.lights.directional_count, lit.lights.lights,
                           lit.lights.profiles.lights, lit.lights.profiles.tables, lit.grid,
                           lit.clusters.offsets, lit.clusters.clusters, lit.clusters.capacity,
                           lit.clusters.order, lit.refined.lists, rest...);
    };
    if (features_.sampled_shadows) {
        enqueue(shadows.offsets, shadows.words, samples.whole, samples.rays, out);
    } else if (features_.shadows) {
        enqueue(shadows.offsets, shadows.words, out);
    } else {
        enqueue(out);
    }
    return out;
}

}  // namespace kilolux
