// SPDX-License-Identifier: Apache-2.0
#include "host/stages/lists/order_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "host/certify/synthetic/random.h"
#include "tests/support/test_gpu.h"

namespace kilolux {
namespace {

// Every tile once, and none after one that has less than two thirds of its entries.
void expect_order(OrderTiles& stage, const std::vector<uint>& entries) {
    const Gpu gpu = test_gpu();
    const auto tiles = static_cast<uint>(entries.size());
    std::vector<uint> offsets = {0};
    std::partial_sum(entries.begin(), entries.end(), std::back_inserter(offsets));
    StageTimer timer;
    const std::vector<uint> order =
        download(gpu, stage.enqueue(new_buffer(gpu, offsets), tiles, timer), tiles);
    std::vector<uint> sorted = order, all(tiles);
    std::ranges::sort(sorted);
    std::iota(all.begin(), all.end(), 0u);
    ASSERT_EQ(sorted, all);
    double least = 1e10;  // of the tiles before
    for (const uint tile : order) {
        ASSERT_LT(entries[tile], std::max(1.5 * least, 1.0)) << tile;
        least = std::min(least, static_cast<double>(entries[tile]));
    }
}

TEST(OrderTiles, HasEveryTileOnceTheFullestFirst) {
    for (const int group : {1, 4, 64}) {
        Tuning tuning;
        tuning.prefix_group = group;
        OrderTiles stage(test_gpu(), tuning, "test");
        expect_order(stage, {7});
        expect_order(stage, {0, 0, 0});
        expect_order(stage, {1, 2, 3, 4, 5, 6, 7, 8, 0, 1u << 30, 3u << 29, 1u << 29});
        expect_order(stage, std::vector<uint>(100, 5));
        Random random(3);
        std::vector<uint> entries(1000);
        for (uint& count : entries) count = random.below(random.below(3000) + 1);
        expect_order(stage, entries);
    }
}

}  // namespace
}  // namespace kilolux
