// SPDX-License-Identifier: Apache-2.0
#include "host/render/forward_inputs.h"

namespace kilolux {

ForwardFeatures forward_features(const ScenePlan& plan, bool clustered, bool opaque) {
    ForwardFeatures features;
    features.shading = plan.kernels.shading;
    features.spot_lights = plan.kernels.spot_lights;
    features.directional_lights = plan.kernels.directional_lights;
    features.metallic = plan.kernels.metallic;
    features.specular = plan.kernels.specular;
    features.unlit = plan.kernels.unlit;
    features.clustered = clustered;
    features.opaque = opaque;
    return features;
}

ForwardLights forward_lights(const LightRows& rows, float ambient, const HostCoarseLists* lists) {
    ForwardLights out;
    out.lights = rows.local;
    out.directional = rows.directional;
    out.ambient = ambient;
    if (lists) {
        out.grid = lists->grid;
        out.cluster_offsets = lists->offsets;
        out.light_lists = lists->lists;
    }
    return out;
}

}  // namespace kilolux
