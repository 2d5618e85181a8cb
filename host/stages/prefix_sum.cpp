// SPDX-License-Identifier: Apache-2.0
#include "host/stages/prefix_sum.h"

#include <algorithm>

namespace kilolux {
namespace {

constexpr std::string_view kStage = "prefix_sum";

BuildOptions options_of(const Tuning& tuning) {
    return BuildOptions()
        .define("GROUP", tuning.prefix_group)
        .define("PER_ITEM", tuning.prefix_per_item);
}

}  // namespace

uint checked_list_size(std::uint64_t entries, std::string_view stage) {
    if (entries > 0xfffffff0u) {
        throw Error(std::string(stage) + ": " + std::to_string(entries) +
                    " (light, cluster) pairs exceed 2^32; use a coarser grid or smaller lights");
    }
    return static_cast<uint>(entries);
}

PrefixSum::PrefixSum(const Gpu& gpu, const Tuning& tuning)
    : gpu_(gpu),
      tuning_(tuning),
      program_(build_program(gpu, kStage, options_of(tuning))),
      block_sums_(gpu, kStage),
      total_(gpu, kStage) {
    total_.reserve(sizeof(std::uint64_t));
}

void PrefixSum::enqueue(const cl::Buffer& counts, uint n, const cl::Buffer& offsets,
                        StageTimer& timer, std::string_view stage) {
    in_stage(stage, [&] {
        const auto group = static_cast<std::size_t>(tuning_.prefix_group);
        const std::size_t block = group * static_cast<std::size_t>(tuning_.prefix_per_item);
        const std::size_t blocks = std::max<std::size_t>((n + block - 1) / block, 1);
        const cl::EnqueueArgs items(gpu_.queue, cl::NDRange(blocks * group), cl::NDRange(group));
        if (blocks == 1) {
            cl::KernelFunctor<cl::Buffer, uint, cl::Buffer, cl::Buffer> one(program_,
                                                                            "prefix_sum_one_block");
            timer.record(stage, one(items, counts, n, offsets, total_.get()));
            return;
        }
        const cl::Buffer& sums = block_sums_.reserve(blocks * sizeof(std::uint64_t));
        cl::KernelFunctor<cl::Buffer, uint, cl::Buffer> sum_blocks(program_, "prefix_sum_blocks");
        timer.record(stage, sum_blocks(items, counts, n, sums));
        cl::KernelFunctor<cl::Buffer, uint, uint, cl::Buffer, cl::Buffer> scan_totals(
            program_, "prefix_sum_totals");
        timer.record(stage, scan_totals(cl::EnqueueArgs(gpu_.queue, cl::NDRange(1), cl::NDRange(1)),
                                        sums, static_cast<uint>(blocks), n, offsets, total_.get()));
        cl::KernelFunctor<cl::Buffer, uint, cl::Buffer, cl::Buffer> apply(program_,
                                                                          "prefix_sum_apply");
        timer.record(stage, apply(items, counts, n, sums, offsets));
    });
}

std::uint64_t PrefixSum::total() const {
    return download<std::uint64_t>(gpu_, total_.get(), 1).front();
}

}  // namespace kilolux
