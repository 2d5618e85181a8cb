// SPDX-License-Identifier: Apache-2.0
#include "host/stages/sum_samples.h"

#include <cassert>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "sum_samples";

// Floats of a picture: three planes of whole vectors of lanes.
std::size_t size_of(const View& view) { return std::size_t{3} * view.stride * view.height; }

}  // namespace

SumSamples::SumSamples(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage)),
      sums_(gpu, kStage),
      mean_(gpu, kStage) {}

void SumSamples::add(const Radiance& radiance, StageTimer& timer) {
    in_stage(kStage, [&] {
        view_ = radiance.view;
        const std::size_t size = size_of(view_);
        const cl::Buffer& sums = sums_.reserve(3 * size * sizeof(float));
        cl::KernelFunctor<uint, uint, cl::Buffer, cl::Buffer> kernel(program_, "sum_samples_add");
        const auto group = static_cast<std::size_t>(tuning_.light_group);
        const std::size_t items = size / static_cast<std::size_t>(gpu_.info.lane_width);
        timer.record(kStage,
                     kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(items, group)),
                                            cl::NDRange(group)),
                            static_cast<uint>(size), count_ == 0 ? 1u : 0u, radiance.planes, sums));
        ++count_;
    });
}

Radiance SumSamples::mean(StageTimer& timer) {
    assert(count_ > 0);
    return in_stage(kStage, [&] {
        const std::size_t size = size_of(view_);
        const Radiance out{mean_.reserve(size * sizeof(float)), view_};
        cl::KernelFunctor<uint, float, cl::Buffer, cl::Buffer> kernel(program_, "sum_samples_mean");
        const auto group = static_cast<std::size_t>(tuning_.light_group);
        const std::size_t items = size / static_cast<std::size_t>(gpu_.info.lane_width);
        timer.record(kStage, kernel(cl::EnqueueArgs(gpu_.queue, cl::NDRange(round_up(items, group)),
                                                    cl::NDRange(group)),
                                    static_cast<uint>(size), static_cast<float>(count_),
                                    sums_.get(), out.planes));
        return out;
    });
}

}  // namespace kilolux
