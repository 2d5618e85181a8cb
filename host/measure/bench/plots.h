// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/row.h"

namespace kilolux {

/// A plot with the stem of its files.
struct NamedPlot {
    std::string stem;
    Plot plot;
};

/// What a sweep's rows show: frame time against lights, speed-up over deferred-all against lights
/// (where it was measured too), and frame and shading time against grid, work-group height, lanes
/// and pixels. An axis with one value makes no plot; what else varies becomes curves.
std::vector<NamedPlot> bench_plots(const std::vector<BenchRow>& rows);

}  // namespace kilolux
