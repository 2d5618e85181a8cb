// SPDX-License-Identifier: Apache-2.0
// What a fragment shows, by the text that the kernels are compiled from. Switches: those of
// kernels/shared/surface_of.h; HAS_MASKS: alpha cuts the material.
#include "raster/shaders/scene.glsl"

struct TextureBuffers {
    uint unused0;
};
struct SurfaceScene {
    uint unused0;
};
struct Pixels {
    float x, y;
};

#define INSTANCE(scene, i) scene_instances[i]
#define MESH(scene, i) scene_meshes[i]
#define MATERIAL(scene, i) scene_materials[i]
#define TEXTURE_ROW(buffers, map) scene_textures[(map).texture]
#define level_offsets(buffers, map, level) scene_textures[(map).texture].level_offset[level]
#define textures_of_scene(scene) TextureBuffers(0u)
#define prefetch_map(buffers, map, at)

uint vertex_index(SurfaceScene scene, uint i) { return texelFetch(scene_indices, int(i)).x; }

float vertex_float(SurfaceScene scene, uint i) { return texelFetch(scene_vertices, int(i)).x; }

float2 vertex_float2(SurfaceScene scene, uint i) {
    return float2(vertex_float(scene, i), vertex_float(scene, i + 1u));
}

float3 vertex_float3(SurfaceScene scene, uint i) {
    return float3(vertex_float2(scene, i), vertex_float(scene, i + 2u));
}

float4 vertex_float4(SurfaceScene scene, uint i) {
    return float4(vertex_float3(scene, i), vertex_float(scene, i + 3u));
}

#include "kernels/shared/surface_scene.h"

Texels fetch_texels(TextureBuffers buffers, Map map, uint place) {
    uvec2 words = texelFetch(scene_maps[map.use], int(place)).xy;
    Texels texels;
    texels.low = words.x;
    texels.high = words.y;
    return texels;
}

#include "kernels/shared/surface_of.h"

// In the picture, of which the target may hold a band.
Pixels fragment_pixels() {
    return Pixels(gl_FragCoord.x, gl_FragCoord.y + float(camera.view.first_row));
}

Fragment drawn_fragment(SurfaceScene scene) {
    Triangle t = mesh_triangle(scene, drawn_instance, uint(gl_PrimitiveID));
    Fragment f = no_fragment();
    interpolate_triangle(scene, camera.view, fragment_pixels(), t, true, f);
    return f;
}

Surface drawn_surface(SurfaceScene scene, Fragment f) {
    Surface s = surface_of_material(scene, textures_of(scene, f.material, f), f);
    Pixels pixels = fragment_pixels();
    s.position = view_position(camera.view, pixels.x, pixels.y, f.z);
    return s;
}

// Whether the material's alpha mask leaves the fragment.
bool is_covered(SurfaceScene scene, Fragment f) {
#if HAS_MASKS
    return passes_cutoff(scene, f.material, alpha_of(scene, f.material, f));
#else
    return true;
#endif
}
