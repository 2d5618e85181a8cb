// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/bench/plot.h"
#include "host/measure/bench/row.h"

namespace kilolux {

/// Frame and shading time against lights, grid, lanes and pixels, and the
/// speed-up over deferred-all against lights where that was measured. An axis with one value makes
/// no plot; what else varies becomes curves.
/// `subtitle`: scene and device; what the points share is added. Bars reach from p5 to p95.
std::vector<NamedPlot> bench_plots(const std::vector<BenchRow>& rows, const std::string& subtitle);

}  // namespace kilolux
