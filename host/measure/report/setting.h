// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// What a setting of a report changes against the one asked for.
enum class Trade { none, gbuffer, lanes, math, grid, renderer, shading, cut_off };
const char* trade_name(Trade trade);

/// One way to render the picture that was asked for, faster or more exactly.
struct ReportSetting {
    Trade trade = Trade::none;
    std::string name;     // "gbuffer half"; unique in a report
    std::string options;  // what the command line says for it; empty for the one asked for
    RenderSettings settings;
};

/// The setting asked for, "default", and then every one that differs from it in one trade.
///
/// Cut-offs are radiances on a white surface (range_of_light()) that decide the range of every
/// light whose file gives none, and of the generated ones. `quick`: fewer grids, lanes and
/// cut-offs, and not `forward`.
std::vector<ReportSetting> report_settings(const Scene& scene, const RenderSettings& base,
                                           const DeviceInfo& device, bool quick);

/// The radiance that the range of the generated lights takes from a white surface, as
/// range_of_light() counts; 0 without them.
double cut_off_of(const Scene& scene, const RenderSettings& settings);

}  // namespace kilolux
