// SPDX-License-Identifier: Apache-2.0
// The sum of evaluate() over a list of lights, or with ALL_LIGHTS over lights 0 .. count - 1, for
// VW pixels. With STAGE > 0 a work-group reads that many lights at a time into local memory, which
// GPUs read faster than global memory through its cache. With LIGHT_GROUPS each light also joins
// the sum of its group.
#ifndef KILOLUX_DEVICE_SUM_LIGHTS_H
#define KILOLUX_DEVICE_SUM_LIGHTS_H
#include "kernels/shading/add_light.h"

static inline uint light_of_entry(global const LIGHT_INDEX* list, uint entry) {
#if ALL_LIGHTS
    return entry;
#else
    return list[entry];
#endif
}

#if STAGE > 0
static inline void stage_batch(LightSet set, global const LIGHT_INDEX* list, uint first, uint end) {
    uint item = get_local_id(1) * get_local_size(0) + get_local_id(0);
    uint items = get_local_size(0) * get_local_size(1);
    for (uint i = item; first + i < end; i += items) {
        uint light = light_of_entry(list, first + i);
        set.staged_indices[i] = light;
        set.staged[i] = LIGHT_AT(set.lights, light);
    }
}
#endif

// Adds the lights of list[0..count) to `total` where `wanted`. The whole work-group calls this with
// the same list: it may stage the lights together.
static inline LightSum sum_lights(LightSum total, bool wanted, ShadingPoint p, LightSet set,
                                  global const LIGHT_INDEX* list, uint count) {
    RunningSum sum = start_sum(total);
#if MARK_CANDIDATES
    FV so_far = fv(0.0f);
#endif
#if STAGE > 0
    for (uint first = 0; first < count; first += STAGE) {
        uint end = min(first + STAGE, count);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch before is used up
        stage_batch(set, list, first, end);
        barrier(CLK_LOCAL_MEM_FENCE);  // the batch is complete
        for (uint i = 0; wanted && i < end - first; ++i) {
            uint light = set.staged_indices[i];
            sum = enter_block(sum, light);
#if SAMPLED_SHADOWS
            ADD_SAMPLED(set, first + i, light, sum.block, GROUP_OF(set, light),
                        EVALUATE(zero_sum(), p, set.staged[i], set.extras, light))
#else
#define STAGED_LIGHT(sum) EVALUATE(sum, p, weighed(set.staged[i]), set.extras, light)
            MARKED(set, first + i, light, sum.block,
                   ADD_SEEN(set, sum.block, GROUP_OF(set, light), set.staged[i].color_scale,
                            sees_entry(set, first + i, light),
                            shadow_point_light(TINT_VIEW(set), set.staged[i]), STAGED_LIGHT))
#endif
        }
    }
#else
    if (!wanted) return total;
    for (uint i = 0; i < count; ++i) {
        uint light = light_of_entry(list, i);
        sum = enter_block(sum, light);
#if SAMPLED_SHADOWS
        ADD_SAMPLED(set, i, light, sum.block, GROUP_OF(set, light),
                    EVALUATE(zero_sum(), p, LIGHT_AT(set.lights, light), set.extras, light))
#else
#define LISTED_LIGHT(sum) EVALUATE(sum, p, weighed(LIGHT_AT(set.lights, light)), set.extras, light)
        MARKED(
            set, i, light, sum.block,
            ADD_SEEN(set, sum.block, GROUP_OF(set, light), LIGHT_AT(set.lights, light).color_scale,
                     sees_entry(set, i, light),
                     shadow_point_light(TINT_VIEW(set), LIGHT_AT(set.lights, light)), LISTED_LIGHT))
#endif
    }
#endif
    return finish_sum(sum);
}

static inline LightSum sum_directional(ShadingPoint p, LightSet set,
                                       global const DirectionalLight* lights, uint count) {
    LightSum sum = zero_sum();
#if HAS_DIRECTIONAL_LIGHTS
    for (uint i = 0; i < count; ++i) {
#if SAMPLED_SHADOWS
        ADD_SAMPLED(set, i, PICKED_DIRECTIONAL + i, sum, GROUP_OF(set, DIRECTIONAL_PLACE(set, i)),
                    evaluate_directional(zero_sum(), p, lights[i]))
#else
#define PARALLEL_LIGHT(sum) evaluate_directional(sum, p, weighed_directional(lights[i]))
        ADD_SEEN(set, sum, GROUP_OF(set, DIRECTIONAL_PLACE(set, i)), lights[i].color,
                 sees_directional(set, i), shadow_directional_light(TINT_VIEW(set), lights[i]),
                 PARALLEL_LIGHT)
#endif
    }
#endif
    return sum;
}
#endif
