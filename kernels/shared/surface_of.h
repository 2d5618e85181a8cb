// SPDX-License-Identifier: Apache-2.0
// A fragment's surface, for OpenCL C and GLSL: factors times textures, as glTF 2.0 defines them.
//
// Each language defines before, beside what texture.h and triangle.h need:
//   MaterialRef, MATERIAL(material)         a material and its row
//   TextureBuffers, textures_of_scene(scene)  where the maps are, and
//   make_map(textures, texture, use)        one of them by its TextureRow's number
//   prefetch_map(map, at)                   asks the caches for what a Lookup reads
//
// TEXTURE_USES has the bit 1 << USE_* of every texture that some material of the scene has and the
// G-buffer keeps. HAS_SPECULAR, HAS_CLEARCOAT, HAS_SHEEN, HAS_ANISOTROPY, HAS_TRANSMISSION,
// HAS_UNLIT: see surface.h.
// HAS_UNLIT_MATERIALS: some are unlit.
#ifndef KILOLUX_SHARED_SURFACE_OF_H
#define KILOLUX_SHARED_SURFACE_OF_H
#include "kernels/shared/surface.h"
#include "kernels/shared/texture.h"
#include "kernels/shared/triangle.h"

#define HAS_USE(use) ((TEXTURE_USES & (1 << (use))) != 0)
#define HAS_TEXCOORDS (HAS_TEXCOORD0 || HAS_TEXCOORD1)

#if HAS_TEXCOORDS
// The place where a use's texture is read: texture coordinates, transformed.
SHARED_FN Footprint footprint_of(MaterialRef material, IN(Fragment) f, uint use) {
#if HAS_TEXCOORD0 && HAS_TEXCOORD1
    Footprint t = AT(f).texcoord0;
    if ((MATERIAL(material).flags & (1u << use)) != 0u) t = AT(f).texcoord1;
#elif HAS_TEXCOORD1
    Footprint t = AT(f).texcoord1;
#else
    Footprint t = AT(f).texcoord0;
#endif
#if HAS_UV_TRANSFORM
    float4 x = MATERIAL(material).row.uv_x[use];
    float4 y = MATERIAL(material).row.uv_y[use];
    Footprint at;
    at.u = fma(fv(x.x), t.u, fma(fv(x.y), t.v, fv(x.z)));
    at.v = fma(fv(y.x), t.u, fma(fv(y.y), t.v, fv(y.z)));
    at.u_dx = fma(fv(x.x), t.u_dx, t.v_dx * x.y);
    at.v_dx = fma(fv(y.x), t.u_dx, t.v_dx * y.y);
    at.u_dy = fma(fv(x.x), t.u_dy, t.v_dy * x.y);
    at.v_dy = fma(fv(y.x), t.u_dy, t.v_dy * y.y);
    return at;
#else
    return t;
#endif
}

SHARED_FN Map map_of(TextureBuffers from, MaterialRef material, uint use) {
    return make_map(from, MATERIAL(material).textures[use], use);
}
#endif

// A material's textures at the fragments.
SHARED_PLAIN_STRUCT(Textures) {
    TextureBuffers from;
    MaterialRef material;
#if MAX_ANISOTROPY == 1 && HAS_TEXCOORDS
    Lookup lookup;  // that of the material's lookup_use
#endif
};

SHARED_FN Textures textures_of(SurfaceScene scene, MaterialRef material, IN(Fragment) f) {
    Textures textures;
    textures.from = textures_of_scene(scene);
    textures.material = material;
#if MAX_ANISOTROPY == 1 && HAS_TEXCOORDS
    uint first = MATERIAL(material).lookup_use;
    if (first != SURFACE_ABSENT) {
        textures.lookup = lookup_isotropic(map_of(textures.from, material, first),
                                           footprint_of(material, f, first));
        for (uint use = 0u; use < USE_COUNT; ++use) {
            if ((MATERIAL(material).lookup_shared & (1u << use)) != 0u) {
                prefetch_map(map_of(textures.from, material, use), REF(textures.lookup));
            }
        }
    }
#endif
    return textures;
}

// The texel of the texture use `use` at the fragments; 1 without a texture.
SHARED_FN FV4 sample_use(IN(Textures) textures, IN(Fragment) f, uint use) {
    FV4 texel;
    texel.x = texel.y = texel.z = texel.w = fv(1.0f);
#if HAS_TEXCOORDS
    MaterialRef material = AT(textures).material;
    if (MATERIAL(material).textures[use] == SURFACE_ABSENT) return texel;
    Map map = map_of(AT(textures).from, material, use);
#if MAX_ANISOTROPY > 1
    if (is_anisotropic(map)) {
        return sample_anisotropic(map, footprint_of(material, f, use));
    }
#else
    if ((MATERIAL(material).lookup_shared & (1u << use)) != 0u) {
        return fetch_map(map, REF(AT(textures).lookup));
    }
#endif
    Lookup at = lookup_isotropic(map, footprint_of(material, f, use));
    texel = fetch_map(map, REF(at));
#endif
    return texel;
}

// The share of the fragments that their material covers: glTF's alpha, with one sample of its
// texture a pixel, whatever the anisotropy.
SHARED_FN FV alpha_of(SurfaceScene scene, MaterialRef material, IN(Fragment) f) {
    FV alpha = fv(MATERIAL(material).row.base_color.w);
#if HAS_USE(USE_BASE_COLOR)
    if (MATERIAL(material).textures[USE_BASE_COLOR] != SURFACE_ABSENT) {
        Map map = map_of(textures_of_scene(scene), material, USE_BASE_COLOR);
        Lookup at = lookup_isotropic(map, footprint_of(material, f, USE_BASE_COLOR));
        alpha *= fetch_alpha(map, REF(at));
    }
#endif
#if HAS_VERTEX_COLOR
    alpha *= AT(f).color.w;
#endif
    return alpha;
}

// Whether alphaMode MASK keeps the fragments.
SHARED_FN MASK passes_cutoff(MaterialRef material, FV alpha) {
    return lane_mask(!(alpha < fv(MATERIAL(material).row.emissive_cutoff.w)));
}

// The share of the fragments that covers what is behind them, from 0 to 1, by any alphaMode.
SHARED_FN FV coverage_of(SurfaceScene scene, MaterialRef material, IN(Fragment) f) {
    FV alpha = alpha_of(scene, material, f);
#if HAS_TRANSMISSION
    uint flags = MATERIAL(material).flags;
    if ((flags & MATERIAL_MASKED) != 0u) {
        alpha = lane_select(passes_cutoff(material, alpha), fv(1.0f), fv(0.0f));
    } else if ((flags & MATERIAL_BLENDED) == 0u) {
        alpha = fv(1.0f);
    }
#endif
    return min(max(alpha, fv(0.0f)), fv(1.0f));
}

// The unit vector along v; +z, towards the viewer, where v has no direction.
SHARED_FN FV3 unit_or_z(FV3 v) {
    FV square = dot3(v, v);
    MASK has_length = lane_and(lane_mask(square > fv(1e-30f)), lane_mask(square < fv(1e30f)));
    FV inv = fv(1.0f) / lane_sqrt(lane_select(has_length, square, fv(1.0f)));
    return fv3(lane_select(has_length, v.x * inv, fv(0.0f)),
               lane_select(has_length, v.y * inv, fv(0.0f)),
               lane_select(has_length, v.z * inv, fv(1.0f)));
}

#if HAS_TANGENT
// The basis (tangent, bitangent, `normal`) times a vector. MikkTSpace: as interpolated,
// unnormalised.
SHARED_FN FV3 from_tangent_space(IN(Fragment) f, FV x, FV y, FV z) {
    FV3 n = AT(f).normal, t = AT(f).tangent;
    FV3 b = scale3(cross3(n, t), AT(f).handedness);
    return fv3(fma(z, n.x, fma(y, b.x, x * t.x)), fma(z, n.y, fma(y, b.y, x * t.y)),
               fma(z, n.z, fma(y, b.z, x * t.z)));
}

// The interpolated normal, turned by the map of the use, whose x and y are scaled.
SHARED_FN FV3 mapped_normal(IN(Textures) textures, IN(Fragment) f, uint use, float scale) {
    FV3 n = AT(f).normal;
    if (MATERIAL(AT(textures).material).textures[use] == SURFACE_ABSENT) return n;
    FV4 texel = sample_use(textures, f, use);
    FV x = fma(texel.x, fv(2.0f), fv(-1.0f)) * scale;
    FV y = fma(texel.y, fv(2.0f), fv(-1.0f)) * scale;
    FV z = fma(texel.z, fv(2.0f), fv(-1.0f));
    return select3(lane_mask(AT(f).handedness != fv(0.0f)), from_tangent_space(f, x, y, z), n);
}
#endif

// The unit normal along n on the side that is lit.
SHARED_FN FV3 facing_normal(MaterialRef material, IN(Fragment) f, FV3 n) {
    if ((MATERIAL(material).flags & MATERIAL_DOUBLE_SIDED) != 0u) {
        n = select3(AT(f).front, n, fv3(-n.x, -n.y, -n.z));
    }
    return unit_or_z(n);
}

SHARED_FN FV3 shading_normal(IN(Textures) textures, IN(Fragment) f) {
    MaterialRef material = AT(textures).material;
    FV3 n = AT(f).normal;
#if HAS_USE(USE_NORMAL)
    n = mapped_normal(textures, f, USE_NORMAL, MATERIAL(material).row.factors.z);
#endif
    return facing_normal(material, f, n);
}

SHARED_FN FV3 times_color(FV3 a, FV4 b) { return fv3(a.x * b.x, a.y * b.y, a.z * b.z); }

SHARED_FN FV3 color_of(float4 c) { return fv3(fv(c.x), fv(c.y), fv(c.z)); }

#if HAS_SPECULAR
// KHR_materials_specular: min(f0 * colour, 1) * weight, and the weight.
SHARED_FN Surface with_specular(IN(Textures) textures, IN(Fragment) f, Surface s) {
    MaterialRef material = AT(textures).material;
    FV3 f0 = color_of(MATERIAL(material).row.specular);
    FV weight = fv(MATERIAL(material).row.specular.w);
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

#if HAS_CLEARCOAT
// KHR_materials_clearcoat. Without a map of its own the coat is as smooth as the vertices' normals.
SHARED_FN Surface with_clearcoat(IN(Textures) textures, IN(Fragment) f, Surface s) {
    MaterialRef material = AT(textures).material;
    s.coat = fv(MATERIAL(material).row.clearcoat.x);
    s.coat_roughness = fv(MATERIAL(material).row.clearcoat.y);
#if HAS_USE(USE_CLEARCOAT)
    s.coat *= sample_use(textures, f, USE_CLEARCOAT).x;
#endif
#if HAS_USE(USE_CLEARCOAT_ROUGHNESS)
    s.coat_roughness *= sample_use(textures, f, USE_CLEARCOAT_ROUGHNESS).y;
#endif
#if HAS_COAT_NORMAL
    FV3 n = AT(f).normal;
#if HAS_USE(USE_CLEARCOAT_NORMAL)
    n = mapped_normal(textures, f, USE_CLEARCOAT_NORMAL, MATERIAL(material).row.clearcoat.z);
#endif
    s.coat_normal = facing_normal(material, f, n);
#else
    s.coat_normal = s.normal;
#endif
    return s;
}
#endif

#if HAS_SHEEN
SHARED_FN Surface with_sheen(IN(Textures) textures, IN(Fragment) f, Surface s) {
    MaterialRef material = AT(textures).material;
    s.sheen = color_of(MATERIAL(material).row.sheen);
    s.sheen_roughness = fv(MATERIAL(material).row.sheen.w);
#if HAS_USE(USE_SHEEN_COLOR)
    s.sheen = times_color(s.sheen, sample_use(textures, f, USE_SHEEN_COLOR));
#endif
#if HAS_USE(USE_SHEEN_ROUGHNESS)
    s.sheen_roughness *= sample_use(textures, f, USE_SHEEN_ROUGHNESS).w;
#endif
    return s;
}
#endif

#if HAS_TRANSMISSION
// KHR_materials_transmission and KHR_materials_volume: light goes the thickness straight through.
SHARED_FN Surface with_transmission(IN(Textures) textures, IN(Fragment) f, Surface s) {
    MaterialRef material = AT(textures).material;
    s.transmission = fv(MATERIAL(material).row.transmission.x);
#if HAS_USE(USE_TRANSMISSION)
    s.transmission *= sample_use(textures, f, USE_TRANSMISSION).x;
#endif
    FV length = AT(f).scale * fv(MATERIAL(material).row.volume.w);
#if HAS_USE(USE_THICKNESS)
    length *= sample_use(textures, f, USE_THICKNESS).y;
#endif
    FV3 log2_of_1m = color_of(MATERIAL(material).row.volume);
    s.tint = fv3(exp2_of_negative(log2_of_1m.x * length), exp2_of_negative(log2_of_1m.y * length),
                 exp2_of_negative(log2_of_1m.z * length));
    return s;
}
#endif

#if HAS_ANISOTROPY && HAS_TANGENT
// KHR_materials_anisotropy: the line along which highlights stretch, perpendicular to the normal
// that is lit. Surfaces without tangents stay round. Seen from behind, normal, tangent and
// bitangent turn round: the line stays.
SHARED_FN Surface with_anisotropy(IN(Textures) textures, IN(Fragment) f, Surface s) {
    MaterialRef material = AT(textures).material;
    float4 factors = MATERIAL(material).row.anisotropy;
    FV strength = fv(factors.x), x = fv(1.0f), y = fv(0.0f);
#if HAS_USE(USE_ANISOTROPY)
    if (MATERIAL(material).textures[USE_ANISOTROPY] != SURFACE_ABSENT) {
        FV4 texel = sample_use(textures, f, USE_ANISOTROPY);
        x = fma(texel.x, fv(2.0f), fv(-1.0f));
        y = fma(texel.y, fv(2.0f), fv(-1.0f));
        strength *= texel.z;
    }
#endif
    FV3 t = from_tangent_space(f, fma(x, fv(factors.y), -y * factors.z),
                               fma(x, fv(factors.z), y * factors.y), fv(0.0f));
    FV along = dot3(s.normal, t);
    t = fv3(fma(-along, s.normal.x, t.x), fma(-along, s.normal.y, t.y),
            fma(-along, s.normal.z, t.z));
    FV square = dot3(t, t);
    MASK has_line = lane_mask(square > fv(1e-12f));
    s.tangent = scale3(t, fv(1.0f) / lane_sqrt(lane_select(has_line, square, fv(1.0f))));
    s.anisotropy = lane_select(has_line, strength, fv(0.0f));
    return s;
}
#endif

// KHR_materials_unlit: the base colour leaves the surface, whatever the lights.
SHARED_FN Surface with_unlit(MaterialRef material, Surface s) {
#if HAS_UNLIT
    s.roughness = max(s.roughness, fv(LIT_ROUGHNESS_MIN));
#endif
    if ((MATERIAL(material).flags & MATERIAL_UNLIT) == 0u) return s;
    s.emissive = s.albedo;
    s.albedo = zero3();
    s.metallic = fv(0.0f);
    s.coat = fv(0.0f);
    s.sheen = zero3();
    s.transmission = fv(0.0f);
#if HAS_UNLIT
    s.roughness = fv(UNLIT_ROUGHNESS);
#else
    s.roughness = fv(1.0f);
#endif
    return s;
}

// The surface of the textures' material at the fragments; its position is not set.
SHARED_FN Surface surface_of_material(IN(Textures) textures, IN(Fragment) f) {
    MaterialRef material = AT(textures).material;
    Surface s = default_surface();
    s.normal = shading_normal(textures, f);
    s.albedo = color_of(MATERIAL(material).row.base_color);
#if HAS_USE(USE_BASE_COLOR)
    s.albedo = times_color(s.albedo, sample_use(textures, f, USE_BASE_COLOR));
#endif
#if HAS_VERTEX_COLOR
    s.albedo =
        fv3(s.albedo.x * AT(f).color.x, s.albedo.y * AT(f).color.y, s.albedo.z * AT(f).color.z);
#endif
    s.emissive = color_of(MATERIAL(material).row.emissive_cutoff);
    s.metallic = fv(MATERIAL(material).row.factors.x);
    s.roughness = fv(MATERIAL(material).row.factors.y);
#if HAS_USE(USE_METALLIC_ROUGHNESS)
    FV4 maps = sample_use(textures, f, USE_METALLIC_ROUGHNESS);
    s.metallic *= maps.z;
    s.roughness *= maps.y;
#endif
#if HAS_USE(USE_OCCLUSION)
    FV occlusion = sample_use(textures, f, USE_OCCLUSION).x;
    s.occlusion = fma(fv(MATERIAL(material).row.factors.w), occlusion - 1.0f, fv(1.0f));
#endif
#if HAS_USE(USE_EMISSIVE)
    s.emissive = times_color(s.emissive, sample_use(textures, f, USE_EMISSIVE));
#endif
#if HAS_SPECULAR
    s = with_specular(textures, f, s);
#endif
#if HAS_CLEARCOAT
    s = with_clearcoat(textures, f, s);
#endif
#if HAS_SHEEN
    s = with_sheen(textures, f, s);
#endif
#if HAS_TRANSMISSION
    s = with_transmission(textures, f, s);
#endif
#if HAS_ANISOTROPY && HAS_TANGENT
    s = with_anisotropy(textures, f, s);
#endif
#if HAS_UNLIT || HAS_UNLIT_MATERIALS
    s = with_unlit(material, s);
#endif
    return s;
}

SHARED_FN Surface take_surface(MASK mask, Surface a, Surface b) {
    a.position = select3(mask, a.position, b.position);
    a.normal = select3(mask, a.normal, b.normal);
#define TAKE_VECTOR(has, member, decoded, plane, value) \
    a.member = select3(mask, a.member, b.member);
#define TAKE_SCALAR(has, member, decoded, plane, value) \
    a.member = lane_select(mask, a.member, b.member);
    SURFACE_VALUES(TAKE_VECTOR, TAKE_SCALAR)
    return a;
}
#endif
