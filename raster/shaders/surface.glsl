// SPDX-License-Identifier: Apache-2.0
// A fragment's surface, by the text that the kernels are compiled from. Switches: those of
// kernels/shared/surface_of.h; HAS_MASKS: alpha cuts the material.
#include "raster/shaders/scene.glsl"

// All buffers have global names: references are numbers.
struct SurfaceScene {
    uint unused0;
};
struct Pixels {
    float x, y;
};
struct Map {
    uint texture_row;
    uint use;
};
#define InstanceRef uint
#define MaterialRef uint
#define VertexRef uint  // its first float

#define INSTANCE(instance) scene_instances[instance]
#define MATERIAL(material) scene_materials[material]
#define MESH(scene, i) scene_meshes[i]
#define TEXTURE_ROW(map) scene_textures[(map).texture_row]
#define level_offsets(map, level) scene_textures[(map).texture_row].level_offset[level]
#define TextureBuffers uint  // nothing: the maps are storage buffers of the shader
#define textures_of_scene(scene) 0u
#define make_map(textures, number, use) Map(number, use)
#define prefetch_map(map, at)
#define vertex_index(scene, i) texelFetch(scene_indices, int(i)).x
#define vertex_row(scene, mesh, i) ((mesh).first_float + (i) * (mesh).vertex_floats)

float vertex_float(VertexRef vertex, uint place) {
    return texelFetch(scene_vertices, int(vertex + place)).x;
}

float2 vertex_float2(VertexRef vertex, uint place) {
    return float2(vertex_float(vertex, place), vertex_float(vertex, place + 1u));
}

float3 vertex_float3(VertexRef vertex, uint place) {
    return float3(vertex_float2(vertex, place), vertex_float(vertex, place + 2u));
}

float4 vertex_float4(VertexRef vertex, uint place) {
    return float4(vertex_float3(vertex, place), vertex_float(vertex, place + 3u));
}

Texels fetch_texels(Map map, uint place) {
    uvec2 words = texelFetch(scene_maps[map.use], int(place)).xy;
    Texels texels;
    texels.low = words.x;
    texels.high = words.y;
    return texels;
}

#include "kernels/shared/surface_of.h"

// The fragment's pixel in the picture; the target may hold a band of it.
Pixels fragment_pixels() {
    return Pixels(gl_FragCoord.x, gl_FragCoord.y + float(camera.view.first_row));
}

Fragment drawn_fragment(SurfaceScene scene) {
    Triangle t = mesh_triangle(scene, drawn_instance, uint(gl_PrimitiveID));
    Fragment f = no_fragment();
    interpolate_triangle(camera.view, fragment_pixels(), t, true, f);
    return f;
}

Surface drawn_surface(SurfaceScene scene, Fragment f) {
    Surface s = surface_of_material(textures_of(scene, f.material, f), f);
    Pixels pixels = fragment_pixels();
    s.position = view_position(camera.view, pixels.x, pixels.y, f.z);
    return s;
}

// Whether the material's alpha mask keeps the fragment.
bool is_covered(SurfaceScene scene, Fragment f) {
#if HAS_MASKS
    return passes_cutoff(f.material, alpha_of(scene, f.material, f));
#else
    return true;
#endif
}
