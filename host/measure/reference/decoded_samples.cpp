// SPDX-License-Identifier: Apache-2.0
#include "host/measure/reference/decoded_samples.h"

#include "host/measure/reference/ray_cast_reference.h"

#include "kernels/shared/gbuffer.h"

namespace kilolux {

SurfaceSample surface_sample(const std::function<double(std::size_t)>& value_of, bool unlit) {
    const auto vector = [&](std::size_t plane) {
        return glm::dvec3(value_of(plane), value_of(plane + 1), value_of(plane + 2));
    };
    SurfaceSample out;
    if (value_of(SURFACE_DEPTH) == 0.0) return out;
    out.position = vector(SURFACE_POSITION);
    out.normal = vector(SURFACE_NORMAL);
#define DECODED_VECTOR(has, member, decoded, plane, value) out.member = vector(decoded);
#define DECODED_SCALAR(has, member, decoded, plane, value) out.member = value_of(decoded);
    SURFACE_VALUES(DECODED_VECTOR, DECODED_SCALAR)
    out.kind =
        unlit && out.roughness == double{UNLIT_ROUGHNESS} ? SurfaceKind::unlit : SurfaceKind::lit;
    return out;
}

SurfaceSamples surface_samples(const DecodedSurfaces& decoded) {
    const View& view = decoded.view;
    SurfaceSamples out =
        make_surface_samples(static_cast<int>(view.width), static_cast<int>(view.height));
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            const std::size_t pixel = y * view.stride + x;
            out.pixels[y * view.width + x] = surface_sample(
                [&](std::size_t plane) { return double{decoded.at(plane, pixel)}; }, decoded.unlit);
        }
    }
    return out;
}

ReferenceOptions reference_options(const KernelFeatures& kernels, const RenderSettings& settings,
                                   const Camera& camera) {
    return {.shading = shading_of(kernels),
            .ambient = double{settings.ambient},
            .orthographic = camera.orthographic,
            .light_d_min = double{kernels.light_d_min},
            .random_ranges = double{kernels.random_ranges}};
}

ReferenceOptions reference_options(const Renderer& renderer, const Camera& camera,
                                   bool casts_shadows) {
    const KernelFeatures& kernels = renderer.plan().kernels;
    ReferenceOptions out = reference_options(kernels, renderer.settings(), camera);
    if (kernels.shadows && casts_shadows) {
        out.shadows = std::make_shared<const ShadowCaster>(renderer.scene(), camera);
        out.tinted_shadows = kernels.tinted_shadows;
    }
    return out;
}

ReferencePicture shade_reference(const LitSurfaces& lit, const ReferenceOptions& options) {
    return shade_reference(surface_samples(lit.surfaces),
                           reference_lights(lit.lights, lit.directional, {lit.webs, lit.shapes}),
                           options);
}

ReferencePicture picture_reference(Renderer& renderer, const Camera& camera,
                                   const ReferenceOptions& options) {
    const LitSurfaces lit = renderer.lit_surfaces();
    if (!has_blended_surfaces(renderer.scene())) return shade_reference(lit, options);
    const RenderSettings& settings = renderer.settings();
    const auto may_end = [&](double) {
        if (options.progress) options.progress(0.0);
    };
    return shade_reference(
        RayCaster(renderer.scene()).cast_layers(camera, settings.width, settings.height, may_end),
        reference_lights(lit.lights, lit.directional, {lit.webs, lit.shapes}), options);
}

}  // namespace kilolux
