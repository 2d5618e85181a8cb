// SPDX-License-Identifier: Apache-2.0
// A fragment's material: factors times textures, as glTF 2.0 defines them; raster/shaders/
// material.glsl is the same for OpenGL's fragments.
//
// TEXTURE_USES: see footprint.h. HAS_SPECULAR, HAS_UNLIT: see surface.h. HAS_UNLIT_MATERIALS: some
// are unlit.
#ifndef KILOLUX_DEVICE_RESOLVED_SURFACE_H
#define KILOLUX_DEVICE_RESOLVED_SURFACE_H
#include "kernels/shared/surface.h"
#include "kernels/surfaces/footprint.h"

// A material's textures at the fragments.
typedef struct Textures {
    TextureBuffers buffers;
    global const SurfaceMaterial* material;
#if MAX_ANISOTROPY == 1
    Lookup lookup;  // that of material->lookup_use
#endif
} Textures;

static inline Textures textures_of(SurfaceScene scene, uint material, const Fragment* f) {
    Textures out;
    out.buffers.rows = scene.textures;
    out.buffers.texels = scene.texels;
    out.material = scene.materials + material;
#if MAX_ANISOTROPY == 1 && (HAS_TEXCOORD0 || HAS_TEXCOORD1)
    uint use = out.material->lookup_use;
    if (use != SURFACE_ABSENT) {
        out.lookup = lookup_isotropic(scene.textures + out.material->textures[use],
                                      footprint_of(out.material, f, use));
        for (uint i = 0; i < USE_COUNT; ++i) {
            if ((out.material->flags & (MATERIAL_SHARES_LOOKUP << i)) != 0u) {
                prefetch_texture(out.buffers, scene.textures + out.material->textures[i],
                                 &out.lookup);
            }
        }
    }
#endif
    return out;
}

// What the texture use `use` reads at the fragments; 1 where it reads none.
static inline FV4 sample_use(const Textures* textures, const Fragment* f, uint use) {
    global const SurfaceMaterial* material = textures->material;
    FV4 out;
    out.x = out.y = out.z = out.w = fv(1.0f);
#if HAS_TEXCOORD0 || HAS_TEXCOORD1
    uint texture = material->textures[use];
    if (texture == SURFACE_ABSENT) return out;
    global const TextureRow* row = textures->buffers.rows + texture;
#if MAX_ANISOTROPY > 1
    if (is_anisotropic(row)) {
        return sample_anisotropic(textures->buffers, row, footprint_of(material, f, use));
    }
#else
    if ((material->flags & (MATERIAL_SHARES_LOOKUP << use)) != 0u) {
        return fetch_texture(textures->buffers, row, &textures->lookup);
    }
#endif
    Lookup at = lookup_isotropic(row, footprint_of(material, f, use));
    out = fetch_texture(textures->buffers, row, &at);
#endif
    return out;
}

// The unit vector along v; +z, towards the viewer, where v has none.
static inline FV3 unit_or_z(FV3 v) {
    FV square = dot3(v, v);
    MASK has_length = lane_mask(square > fv(1e-30f)) & lane_mask(square < fv(1e30f));
    FV inv = fv(1.0f) / lane_sqrt(lane_select(has_length, square, fv(1.0f)));
    return fv3(lane_select(has_length, v.x * inv, fv(0.0f)),
               lane_select(has_length, v.y * inv, fv(0.0f)),
               lane_select(has_length, v.z * inv, fv(1.0f)));
}

static inline FV3 shading_normal(const Textures* textures, const Fragment* f) {
    global const SurfaceMaterial* material = textures->material;
    FV3 n = f->normal;
#if HAS_USE(USE_NORMAL)
    if (material->textures[USE_NORMAL] != SURFACE_ABSENT) {
        // MikkTSpace: the basis as interpolated, unnormalised, and the sum normalised.
        FV4 texel = sample_use(textures, f, USE_NORMAL);
        float scale = material->row.factors.z;
        FV x = fma(texel.x, fv(2.0f), fv(-1.0f)) * scale;
        FV y = fma(texel.y, fv(2.0f), fv(-1.0f)) * scale;
        FV z = fma(texel.z, fv(2.0f), fv(-1.0f));
        FV3 bitangent = scale3(cross3(f->normal, f->tangent), f->handedness);
        FV3 mapped = fv3(fma(z, n.x, fma(y, bitangent.x, x * f->tangent.x)),
                         fma(z, n.y, fma(y, bitangent.y, x * f->tangent.y)),
                         fma(z, n.z, fma(y, bitangent.z, x * f->tangent.z)));
        n = select3(lane_mask(f->handedness != fv(0.0f)), mapped, n);
    }
#endif
    if ((material->flags & MATERIAL_DOUBLE_SIDED) != 0u) {
        n = select3(f->front, n, fv3(-n.x, -n.y, -n.z));
    }
    return unit_or_z(n);
}

static inline FV3 times_color(FV3 a, FV4 b) { return fv3(a.x * b.x, a.y * b.y, a.z * b.z); }

static inline FV3 color_of(float4 c) { return fv3(fv(c.x), fv(c.y), fv(c.z)); }

#if HAS_SPECULAR
// KHR_materials_specular: min(f0 * colour, 1) * weight, and the weight.
static inline Surface with_specular(const Textures* textures, const Fragment* f, Surface s) {
    global const SurfaceMaterial* material = textures->material;
    FV3 f0 = color_of(material->row.specular);
    FV weight = fv(material->row.specular.w);
#if HAS_USE(USE_SPECULAR_COLOR)
    f0 = times_color(f0, sample_use(textures, f, USE_SPECULAR_COLOR));
#endif
#if HAS_USE(USE_SPECULAR)
    weight *= sample_use(textures, f, USE_SPECULAR).w;
#endif
    FV one = fv(1.0f);
    s.specular = scale3(fv3(min(f0.x, one), min(f0.y, one), min(f0.z, one)), weight);
    s.specular_f90 = weight;
    return s;
}
#endif

// KHR_materials_unlit: the base colour is what leaves the surface, whatever the lights.
static inline Surface with_unlit(global const SurfaceMaterial* material, Surface s) {
#if HAS_UNLIT
    s.roughness = max(s.roughness, fv(1.0f / 255.0f));  // 0 says unlit
#endif
    if ((material->flags & MATERIAL_UNLIT) == 0u) return s;
    s.emissive = s.albedo;
    s.albedo = zero3();
    s.metallic = fv(0.0f);
    s.roughness = fv(1.0f - (float)HAS_UNLIT);
    return s;
}

static inline Surface background_surface() {
    Surface s;
    s.position = s.albedo = s.emissive = zero3();
    s.normal = fv3(fv(0.0f), fv(0.0f), fv(1.0f));
    s.roughness = s.metallic = s.occlusion = fv(0.0f);
#if HAS_SPECULAR
    s.specular = zero3();
    s.specular_f90 = fv(0.0f);
#endif
    return s;
}

// The surface of `material` at every pixel; its position is not set.
static inline Surface surface_of_material(const Textures* textures, const Fragment* f) {
    global const SurfaceMaterial* material = textures->material;
    Surface s;
    s.position = zero3();
    s.normal = shading_normal(textures, f);
    s.albedo = color_of(material->row.base_color);
#if HAS_USE(USE_BASE_COLOR)
    s.albedo = times_color(s.albedo, sample_use(textures, f, USE_BASE_COLOR));
#endif
#if HAS_VERTEX_COLOR
    s.albedo = fv3(s.albedo.x * f->color.x, s.albedo.y * f->color.y, s.albedo.z * f->color.z);
#endif
    s.emissive = color_of(material->row.emissive_cutoff);
    s.metallic = fv(material->row.factors.x);
    s.roughness = fv(material->row.factors.y);
    s.occlusion = fv(1.0f);
#if HAS_USE(USE_METALLIC_ROUGHNESS)
    FV4 maps = sample_use(textures, f, USE_METALLIC_ROUGHNESS);
    s.metallic *= maps.z;
    s.roughness *= maps.y;
#endif
#if HAS_USE(USE_OCCLUSION)
    FV occlusion = sample_use(textures, f, USE_OCCLUSION).x;
    s.occlusion = fma(fv(material->row.factors.w), occlusion - 1.0f, fv(1.0f));
#endif
#if HAS_USE(USE_EMISSIVE)
    s.emissive = times_color(s.emissive, sample_use(textures, f, USE_EMISSIVE));
#endif
#if HAS_SPECULAR
    s = with_specular(textures, f, s);
#endif
#if HAS_UNLIT || HAS_UNLIT_MATERIALS
    s = with_unlit(material, s);
#endif
    return s;
}

static inline Surface take_surface(MASK mask, Surface a, Surface b) {
    a.position = select3(mask, a.position, b.position);
    a.normal = select3(mask, a.normal, b.normal);
    a.albedo = select3(mask, a.albedo, b.albedo);
    a.emissive = select3(mask, a.emissive, b.emissive);
    a.roughness = lane_select(mask, a.roughness, b.roughness);
    a.metallic = lane_select(mask, a.metallic, b.metallic);
    a.occlusion = lane_select(mask, a.occlusion, b.occlusion);
#if HAS_SPECULAR
    a.specular = select3(mask, a.specular, b.specular);
    a.specular_f90 = lane_select(mask, a.specular_f90, b.specular_f90);
#endif
    return a;
}

// The surfaces of fragments, each of its own material.
static inline Surface resolve_materials(SurfaceScene scene, const Fragment* f, MASK drawn) {
    Surface s = background_surface();
    for (MASK left = drawn; lane_any(left);) {
        uint material = first_of(f->material, left);
        MASK mask = lane_mask(f->material == (UV)(material)) & left;
        Textures textures = textures_of(scene, material, f);
        s = take_surface(mask, surface_of_material(&textures, f), s);
        left &= ~mask;
    }
    return s;
}
#endif
