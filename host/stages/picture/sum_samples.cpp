// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/sum_samples.h"

#include <cassert>

namespace kilolux {
namespace {

// Floats of a picture: three planes of whole vectors of lanes.
uint floats_of(const View& view) { return 3 * view.stride * view.height; }

}  // namespace

SumSamples::SumSamples(const Gpu& gpu, const Tuning& tuning)
    : group_(tuning.light_group),
      program_(build_program(gpu, kSumSamplesStage)),
      add_(gpu, program_, kSumSamplesStage, "sum_samples_add"),
      mean_kernel_(gpu, program_, kSumSamplesStage, "sum_samples_mean"),
      sums_(gpu, kSumSamplesStage),
      mean_(gpu, kSumSamplesStage) {}

WorkSize SumSamples::work_size() const { return add_.vector_items(floats_of(view_), group_); }

void SumSamples::add(const Radiance& radiance, StageTimer& timer) {
    view_ = radiance.view;
    const uint size = floats_of(view_);
    const DeviceArray<float> sums = sums_.reserve(kSumFloats * size);
    add_.enqueue(work_size(), timer, size, count_ == 0 ? 1u : 0u, radiance.planes, sums);
    ++count_;
}

Radiance SumSamples::mean(StageTimer& timer) {
    assert(count_ > 0);
    Radiance out{mean_.reserve(floats_of(view_)), view_};
    mean_kernel_.enqueue(work_size(), timer, floats_of(view_), static_cast<float>(count_),
                         sums_.get(), out.planes);
    return out;
}

}  // namespace kilolux
