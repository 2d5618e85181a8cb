// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kilolux {

/// Counts of one frame's lists.
struct ListCounts {
    std::uint64_t coarse_pairs = 0;  // (light, coarse cluster)
    std::uint64_t active_clusters = 0;
    std::uint64_t refine_tests = 0;   // lights of the active clusters' coarse lists
    std::uint64_t refined_pairs = 0;  // (light, active cluster)
    std::uint64_t drawn_pixels = 0;   // that are not background
    std::uint64_t evaluations = 0;    // (light, pixel) of the refined lists

    ListCounts& operator+=(const ListCounts& other) {
        coarse_pairs += other.coarse_pairs;
        active_clusters += other.active_clusters;
        refine_tests += other.refine_tests;
        refined_pairs += other.refined_pairs;
        drawn_pixels += other.drawn_pixels;
        evaluations += other.evaluations;
        return *this;
    }
};

}  // namespace kilolux
