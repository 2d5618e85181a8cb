// SPDX-License-Identifier: Apache-2.0
#include "host/render/light_lists.h"

namespace kilolux {

ListStages::ListStages(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : prepare_(gpu, tuning), build_(gpu), cull_(gpu, tuning, features), bin_(gpu, tuning, features), refine_(gpu, tuning, features) {}

LightLists ListStages::enqueue(const LightInput& input, const GBuffer& gbuffer, const ClusterGrid& grid, StageTimer& timer) {
    LightLists lists;
    lists.lights = prepare_.enqueue(input, gbuffer.view, grid, timer);
    lists.boxes = build_.enqueue(gbuffer.view, grid, timer);
    lists.coarse = cull_.enqueue(lists.lights, lists.boxes, timer);
    lists.clusters = bin_.enqueue(gbuffer, grid, timer);
    lists.refined = refine_.enqueue(lists.lights, lists.coarse, lists.clusters, gbuffer.view, grid, timer);
    return lists;
}

bool ListStages::fit() {
    // The later stages' needs are known only once the earlier ones are complete.
    const bool coarse = cull_.fits();
    const bool active = bin_.fits();
    return coarse && active && refine_.fits();
}

}  // namespace kilolux
