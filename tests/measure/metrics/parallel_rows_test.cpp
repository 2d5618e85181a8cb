// SPDX-License-Identifier: Apache-2.0
#include "host/measure/metrics/parallel_rows.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "host/base/error.h"

namespace kilolux {
namespace {

TEST(ParallelRows, CallsEveryRowOnce) {
    for (const int count : {0, 1, 2, 3, 1000}) {
        std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
        parallel_rows(count, [&](int row) { ++calls[static_cast<std::size_t>(row)]; });
        for (const auto& c : calls) EXPECT_EQ(c, 1) << count << " rows";
    }
}

TEST(ParallelRows, ProgressRisesToOne) {
    std::vector<double> shares;
    parallel_rows(
        97, [](int) {}, [&](double share) { shares.push_back(share); });
    ASSERT_EQ(shares.size(), 97u);
    for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]);
    EXPECT_EQ(shares.back(), 1.0);
}

TEST(ParallelRows, ExceptionOfARowComesOut) {
    const auto body = [](int row) {
        if (row == 13) throw Error("row 13");
    };
    EXPECT_THROW(parallel_rows(1000, body), Error);
}

TEST(ParallelRows, ExceptionOfProgressStopsTheWork) {
    std::atomic<int> rows = 0;
    const auto stop = [](double) { throw Interrupted(); };
    EXPECT_THROW(parallel_rows(
                     100000, [&](int) { ++rows; }, stop),
                 Interrupted);
    EXPECT_LT(rows, 1000);
}

}  // namespace
}  // namespace kilolux
