// SPDX-License-Identifier: Apache-2.0
#include "host/stages/picture/sum_samples.h"

#include <cassert>

namespace kilolux {
SumSamples::SumSamples(const Gpu& gpu, const Tuning& tuning)
    : group_(tuning.light_group),
      program_(build_program(gpu, kSumSamplesStage)),
      add_(gpu, program_, kSumSamplesStage, "sum_samples_add"),
      mean_kernel_(gpu, program_, kSumSamplesStage, "sum_samples_mean"),
      sums_(gpu, kSumSamplesStage),
      mean_(gpu, kSumSamplesStage) {}

void SumSamples::add(const Radiance& radiance, StageTimer& timer) {
    last_ = radiance;
    const std::size_t size = radiance.floats();
    const DeviceArray<float> sums = sums_.reserve(kSumFloats * size);
    add_.enqueue(work_size(), timer, static_cast<uint>(size), count_ == 0 ? 1u : 0u,
                 radiance.planes, sums);
    ++count_;
}

WorkSize SumSamples::work_size() const { return add_.vector_items(last_.floats(), group_); }

Radiance SumSamples::mean(StageTimer& timer) {
    assert(count_ > 0);
    Radiance out{mean_.reserve(last_.floats()), last_.view, last_.groups};
    mean_kernel_.enqueue(work_size(), timer, static_cast<uint>(last_.floats()),
                         static_cast<float>(count_), sums_.get(), out.planes);
    return out;
}

}  // namespace kilolux
