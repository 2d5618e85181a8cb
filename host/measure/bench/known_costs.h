// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/bench/feature_cost.h"

namespace kilolux {

/// What each feature that the plan leaves out would cost on this picture: bytes a pixel always, and
/// times as they were last measured for the same scene and settings on this device. A feature whose
/// time was not measured yet has `measured` false, and `why` says how to.
std::vector<FeatureCost> known_feature_costs(const DeviceInfo& device, const Scene& scene,
                                             const RenderSettings& settings);

/// Keeps measured costs in the user's cache folder for known_feature_costs(). Throws Error when
/// they cannot be written.
void keep_feature_costs(const DeviceInfo& device, const Scene& scene,
                        const RenderSettings& settings, const std::vector<FeatureCost>& costs);

}  // namespace kilolux
