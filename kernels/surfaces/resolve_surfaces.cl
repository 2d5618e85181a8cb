// SPDX-License-Identifier: Apache-2.0
// Triangle ids -> G-buffer: each pixel's triangle is interpolated, its textures are sampled, and
// the planes of the layout are written. One work-item resolves a block of VW pixels.
//
// Triangles are set up one by one, in scalars, and evaluated in all lanes: a block shows few of
// them. Texels are fetched lane by lane and filtered in lanes. A CPU would wait for most of them,
// so the texels of all textures of a material are prefetched before the first is read. With one
// lane there are no blocks: their code costs an H200 a fifth of the time of this kernel.
#define BLOCK_PIXELS (VW > 1)
#include "kernels/device/arguments.h"
#include "kernels/surfaces/resolved_surface.h"
#include "kernels/surfaces/store_gbuffer.h"

kernel void resolve_surfaces(
    global const uint* restrict ids,  // [height][stride]: triangle + 1; 0 for background
    View view, GBufferLayout layout, SCENE_ARGS, BUCKET_ARGS,
    global uchar* restrict gbuffer) {  // out: the layout's planes
    uint x = (uint)get_global_id(0) * VW;
    uint y = get_global_id(1);
    if (y - y % BLOCK_ROWS >= view.height) return;
    Pixels pixels = block_pixels(view, x, y);
    UV id = load_block(ids + pixels.first, pixels, view.stride);
    MASK shown = lane_mask(id != (UV)(0u)) & within_picture(view, pixels);
    GBufferTarget to = {gbuffer, layout, view, SRGB_TABLE_OF_ARGS, pixels, shown};
    if (!lane_any(shown)) {
        store_surface(to, default_surface(), fv(1.0f));
        return;
    }
    SurfaceScene scene = SCENE_OF_ARGS;
    Fragment fragment = interpolate_fragment(scene, view, pixels, id, shown);
    Surface s = resolve_materials(scene, &fragment, shown);
    s.position = view_position(view, pixels.x, pixels.y, fragment.z);
    store_surface(to, s, fragment.z);
}
