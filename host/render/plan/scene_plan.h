// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "host/gpu/features.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace kilolux {

/// The features that a scene needs, and so those that are compiled in and stored.
struct ScenePlan {
    std::vector<std::string> features;  // in use, by name
    std::vector<std::string> left_out;  // not needed, so neither compiled nor stored
    KernelFeatures kernels;
    GBufferNeeds gbuffer;
    int gbuffer_bytes_per_pixel = 0;
    bool transmission = false;  // of blended surfaces; `kernels` and `gbuffer` may leave it out

    /// The same for the surfaces that blend.
    ScenePlan of_layers() const;
    bool operator==(const ScenePlan&) const = default;
};

/// The names that RenderSettings::force_features takes: features of kernels and G-buffer, and
/// shading models. Other features cost nothing where they are absent, since each material's shader
/// has its own.
const std::vector<std::string>& forceable_features();

/// The plan for a scene under these settings. `light_count`: point and spot lights at most. Throws
/// Error when settings.force_features names something else.
ScenePlan make_scene_plan(const Scene& scene, const RenderSettings& settings,
                          std::uint64_t light_count);

/// The kernels that find the illuminance of the surfaces of a plan.
KernelFeatures illuminance_features(KernelFeatures kernels);

/// Bytes a pixel that the G-buffer would grow by with a feature that the plan leaves out.
int added_bytes_per_pixel(const ScenePlan& plan, std::string_view feature);

}  // namespace kilolux
