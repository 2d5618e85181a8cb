// SPDX-License-Identifier: Apache-2.0
// Camera-relative lights -> view space, and the part of the coarse grid that each can touch.
// One work-item prepares VW lights; the last one may have fewer.
#include "kernels/device/arguments.h"
#include "kernels/device/lanes.h"
#include "kernels/shared/lights/light_transform.h"

// Tiles [first, last] that the interval [lo, hi] in pixels touches, with a hundredth of a tile to
// spare for rounding; an interval beside the screen gives first > last.
static inline UV tile_interval(FV lo, FV hi, uint tile_size, uint tiles) {
    float inv = 1.0f / (float)tile_size;
    float end = (float)tiles;
    FV first = floor(clamp(fma(lo, fv(inv), fv(-0.01f)), fv(-1.0f), fv(end)));
    FV last = floor(clamp(fma(hi, fv(inv), fv(0.01f)), fv(-1.0f), fv(end)));
    UV first_tile = lane_to_uint(max(first, fv(0.0f)));
    // A screen is at least a tile wide: last = -1 becomes an empty interval, first 1 and last 0.
    MASK outside = (last < fv(0.0f)) | (first >= fv(end));
    UV last_tile = lane_to_uint(clamp(last, fv(0.0f), fv(end - 1.0f)));
    UV interval = first_tile | (last_tile << 16);
    return select(interval, (UV)(1u), lane_mask(outside));
}

// Pixels that x_view / scale can take for x in [lo, hi] and scale in [near, far] > 0, along one
// axis with pixel = (ratio - offset) / step.
typedef struct Interval {
    FV lo, hi;
} Interval;

static inline Interval pixel_interval(FV lo, FV hi, FV near, FV far, float step, float offset) {
    FV ratio_lo = lo / lane_select(lo >= fv(0.0f), far, near);
    FV ratio_hi = hi / lane_select(hi >= fv(0.0f), near, far);
    FV a = (ratio_lo - offset) / step;
    FV b = (ratio_hi - offset) / step;
    Interval pixels;
    pixels.lo = min(a, b);
    pixels.hi = max(a, b);
    return pixels;
}

typedef struct Sphere {
    FV x, y, z;  // depth z, positive forward
    FV radius;
} Sphere;

static inline void store_extents(global LightExtent* extents, uint first, uint count, UV slices,
                                 UV columns, UV rows) {
    uint s[VW], c[VW], r[VW];
    lane_store(slices, s);
    lane_store(columns, c);
    lane_store(rows, r);
    for (uint i = 0; i < VW && first + i < count; ++i) {
        LightExtent extent;
        extent.slices = s[i];
        extent.columns = c[i];
        extent.rows = r[i];
        extent.unused0 = 0;
        extents[first + i] = extent;
    }
}

static inline void find_extents(View view, ClusterGrid grid, Sphere sphere, uint first, uint count,
                                global LightExtent* extents) {
    FV zero = fv(0.0f);
    FV z_lo = sphere.z - sphere.radius;
    FV z_hi = sphere.z + sphere.radius;
    bool perspective = view.orthographic == 0u;
    // Pixels of a perspective view lie in front of the camera; 1e-30 keeps the ratios finite.
    FV near = perspective ? max(z_lo, fv(1e-30f)) : fv(1.0f);
    FV far = perspective ? max(z_hi, fv(1e-30f)) : fv(1.0f);
    Interval px = pixel_interval(sphere.x - sphere.radius, sphere.x + sphere.radius, near, far,
                                 view.ray.x, view.ray.y);
    Interval py = pixel_interval(sphere.y - sphere.radius, sphere.y + sphere.radius, near, far,
                                 view.ray.z, view.ray.w);
    UV columns = tile_interval(px.lo, px.hi, grid.tile_width, grid.tiles_x);
    UV rows = tile_interval(py.lo, py.hi, grid.tile_height, grid.tiles_y);
    UV slices = slice_of_depth(grid, z_lo) | (slice_of_depth(grid, z_hi) << 16);
    MASK behind = perspective ? lane_mask(z_hi <= zero) : lane_mask(zero > zero);
    store_extents(extents, first, count, select(slices, (UV)(1u), behind), columns, rows);
}

kernel void prepare_lights(global const Light* restrict own,  // camera-relative, world axes
                           uint seed,  // of random ranges; 0: no range is random
                           View view, ClusterGrid grid,
                           LIGHT_ARGS()) {  // out: lights, bounds, extents
    uint count = light_count + node_count;
    uint first = (uint)get_global_id(0) * VW;
    if (first >= count) return;
    float x[VW], y[VW], z[VW], r[VW];
    for (uint i = 0; i < VW; ++i) {
        uint light = min(first + i, count - 1u);
        ShadeLight out = shade_light(view, own[light], light, seed);
        float4 p = out.position_inv_range2;
        p.w = inv_range2_of(out);
        float range = has_random_range(out) ? sqrt(1.0f / p.w) : range_of(own[light]);
        lights[light] = out;
        bounds[light] = p;
        x[i] = p.x;
        y[i] = p.y;
        z[i] = -p.z;
        // More than CULL_LIMIT allows in the list test (1e-6 of the range) and than float32 loses
        // on the way to tiles (16 u of the position); 1e-18 m where both are denormal, which a
        // device may flush.
        r[i] = fma(range, 1.00001f,
                   1e-6f * (fabs(p.x) + fabs(p.y) + fabs(p.z)) + grid.position_pad + 1e-18f);
    }
    Sphere sphere;
    sphere.x = lane_load(x);
    sphere.y = lane_load(y);
    sphere.z = lane_load(z);
    sphere.radius = lane_load(r);
    find_extents(view, grid, sphere, first, count, extents);
}

// Directional lights: their direction in view space.
kernel void prepare_directional_lights(
    global const DirectionalLight* restrict lights,  // [count], world axes
    View view,
    global DirectionalLight* restrict out) {  // out [count], view space
    uint light = get_global_id(0);
    out[light].to_light = rotated(view, lights[light].to_light, 0.0f);
    out[light].color = lights[light].color;
}

// Vectors of lights' extras in view space; w stays as it is.
kernel void turn_rows(global const float4* restrict rows,  // [count], world axes
                      uint count, View view,
                      global float4* restrict out) {  // out [count], view space
    uint row = get_global_id(0);
    if (row < count) out[row] = rotated(view, rows[row], rows[row].w);
}
