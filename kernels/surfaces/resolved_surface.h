// SPDX-License-Identifier: Apache-2.0
// The surfaces of fragments, each of its own material (kernels/shared/surface_of.h).
#ifndef KILOLUX_DEVICE_RESOLVED_SURFACE_H
#define KILOLUX_DEVICE_RESOLVED_SURFACE_H
#include "kernels/device/triangle.h"
#include "kernels/shared/surface_of.h"

static inline Surface resolve_materials(SurfaceScene scene, const Fragment* f, MASK shown) {
    Surface s = default_surface();
    for (MASK left = shown; lane_any(left);) {
        uint material = first_of(f->material, left);
        MASK mask = lane_mask(f->material == (UV)(material)) & left;
        Textures textures = textures_of(scene, scene.materials + material, f);
        s = take_surface(mask, surface_of_material(&textures, f), s);
        left &= ~mask;
    }
    return s;
}
#endif
