// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/prefix_sum.h"

#include <gtest/gtest.h>

#include "host/certify/synthetic/random.h"
#include "host/gpu/memory/list_size.h"
#include "tests/support/cl_calls.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

struct Sums {
    std::vector<uint> offsets;
    std::uint64_t total;
};

Sums expected_sums(const std::vector<uint>& counts) {
    Sums sums{{}, 0};
    for (const uint count : counts) {
        sums.offsets.push_back(static_cast<uint>(sums.total));
        sums.total += count;
    }
    sums.offsets.push_back(static_cast<uint>(sums.total));
    return sums;
}

Tuning tuning_of(int group, int per_item) {
    Tuning tuning;
    tuning.prefix_group = group;
    tuning.prefix_per_item = per_item;
    return tuning;
}

void expect_sums(PrefixSum& stage, const std::vector<uint>& counts, const std::string& what) {
    Gpu gpu = test_gpu();
    const auto n = static_cast<uint>(counts.size());
    constexpr uint kGuard = 0xdeadbeefu;
    const cl::Buffer in = new_buffer(gpu, counts);
    const cl::Buffer out = new_buffer(gpu, std::vector<uint>(n + 2, kGuard));
    StageTimer timer;
    stage.enqueue(in, n, out, timer);
    const Sums expected = expected_sums(counts);
    const auto found = download<uint>(gpu, out, n + 2);
    ASSERT_EQ(download(gpu, stage.total()).front(), expected.total) << what;
    ASSERT_EQ(std::vector<uint>(found.begin(), found.end() - 1), expected.offsets) << what;
    ASSERT_EQ(found.back(), kGuard) << what << ": written beyond the end";
}

std::vector<uint> random_counts(std::size_t n, uint end) {
    Random random(static_cast<std::uint32_t>(n) + 1);
    std::vector<uint> counts(n);
    for (uint& count : counts) count = end == 0 ? random.bits() : random.below(end);
    return counts;
}

TEST(PrefixSum, AgreesWithTheSumAtEveryBlockSizeAndLength) {
    for (const auto& [group, per_item] : {std::pair{1, 4096}, {1, 1}, {4, 3}, {64, 8}, {256, 1}}) {
        PrefixSum stage(test_gpu(), tuning_of(group, per_item), "test");
        const auto block = static_cast<std::size_t>(group * per_item);
        for (const std::size_t n :
             {std::size_t{0}, std::size_t{1}, std::size_t{2}, block - 1, block, block + 1,
              2 * block, 3 * block + 5, std::size_t{5001}, std::size_t{17000}}) {
            expect_sums(stage, random_counts(n, 1000),
                        std::to_string(group) + " x " + std::to_string(per_item) +
                            ", n = " + std::to_string(n));
        }
    }
}

TEST(PrefixSum, FewBlocksTakeOneLaunch) {
    const Gpu gpu = test_gpu();
    PrefixSum stage(gpu, tuning_of(64, 8), "test");
    for (const auto& [blocks, launches] : {std::pair{1u, 1}, {2u, 1}, {33u, 1}, {34u, 3}}) {
        const std::vector<uint> counts(512 * blocks, 1u);
        const cl::Buffer in = new_buffer(gpu, counts);
        const cl::Buffer out = new_buffer(gpu, std::vector<uint>(counts.size() + 1));
        StageTimer timer;
        const ClCalls before = cl_calls();
        stage.enqueue(in, 512 * blocks, out, timer);
        EXPECT_EQ((cl_calls() - before).launches, launches) << blocks;
    }
}

TEST(PrefixSum, TotalIsExactBeyond32Bits) {
    for (const auto& [group, per_item] : {std::pair{1, 4096}, {64, 8}}) {
        PrefixSum stage(test_gpu(), tuning_of(group, per_item), "test");
        expect_sums(stage, random_counts(10000, 0), "random 32-bit counts");
        expect_sums(stage, std::vector<uint>(5000, 0xffffffffu), "largest counts");
    }
}

TEST(CountedList, TooManyEntriesAreNamed) {
    EXPECT_EQ(checked_list_size(kMostEntries, "cull_lights", "pairs"), kMostEntries);
    const Gpu gpu = test_gpu();
    CountedList list(gpu, default_tuning(gpu.info), "bin_triangles", "(triangle, tile) pairs", 4);
    try {
        list.fits(std::uint64_t{0xfffffff1});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "bin_triangles: 4294967281 (triangle, tile) pairs are more than "
                     "32 bits number");
    }
}

}  // namespace
}  // namespace kilolux
