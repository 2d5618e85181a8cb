// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/gpu/features.h"
#include "host/measure/metrics/parallel_rows.h"
#include "host/measure/metrics/rgb_image.h"
#include "host/measure/reference/reference_lights.h"
#include "host/measure/reference/shadow_caster.h"
#include "host/measure/reference/surface_samples.h"
#include "host/render/settings.h"

namespace kilolux {

/// How far (d/range)^2 must be below 1 for a light to reach a pixel in any rounding: 80 roundings
/// of float32; the kernels make about ten.
inline constexpr double kReachMargin = 1e-5;

/// The kernels' shading model as a setting, which is not `automatic`.
inline Shading shading_of(const KernelFeatures& kernels) {
    return shading_of_model(kernels.shading);
}

/// The model of a reference picture.
struct ReferenceOptions {
    Shading shading = Shading::lambert;  // not automatic
    double ambient = 0.0;                // incident radiance, the same from every direction
    bool orthographic = false;           // rays to the eye are parallel to +Z
    double light_d_min = 0.01;           // nearer than this the inverse square stops growing [m]
    double random_ranges = 0.0;          // RANDOM_RANGES of evaluate.h, for lights that have one
    bool windowed = true;                // false: unbounded inverse square, no light has a range
    double area_tolerance = 1e-6;        // relative, of the integral over a light with a size
    int area_steps = 24;  // even; with shadows, rays to a light that is seen in part are its square
    OnProgress progress{};
    std::shared_ptr<const ShadowCaster> shadows{};  // none: every light is seen
    bool tinted_shadows = false;  // with shadows: surfaces that blend or transmit take their part
};

struct ReferencePicture {
    RgbImage radiance;
    RgbImage scale;  // E = sum |intensity * attenuation| of the lights: the unit of relative errors
    double lights_per_pixel = 0.0;  // k*: point and spot lights in reach, mean over hit pixels
    // Lights per pixel that are in reach in any rounding: (d/range)^2 < 1 - kReachMargin, and
    // inside a spot's cone by the same margin.
    std::vector<std::uint32_t> reaching{};
};

/// Shades every pixel with every light in double: brute force, no culling.
///
///   pixel = emissive + ambient * occlusion * albedo
///           + sum of brdf * intensity * attenuation * max(n.l, 0)
/// A light with a size: the integral over its solid angle of luminance * brdf * n.l, times its
/// window.
///   attenuation = clamp(1 - (d/range)^4, 0, 1) / max(d, light_d_min)^2
///                 * clamp((cos - cos_out) scale, 0, 1)^2 * photometric web's share of its peak
/// The direction to a light at distance d is v / max(d, light_d_min); a light at the shading point
/// adds 0. Relative error of the sums below 1e-14 for any number and order of lights.
///
/// R1, the kernels' error: `surfaces` decoded from the G-buffer, `lights` from its float32 rows.
/// R2, the G-buffer's: `surfaces` from RayCaster. R3, the error of limited ranges: `windowed` =
/// false. Runs on all cores: 320x180 pixels with 1000 lights take about a second on two.
ReferencePicture shade_reference(const SurfaceSamples& surfaces, const ReferenceLights& lights,
                                 const ReferenceOptions& options);

/// The same with surfaces that blend over the first ones, from far to near: of each, the share that
/// it covers of its own radiance, and what it lets through of the radiance behind. Counts of lights
/// are those of the first surfaces.
ReferencePicture shade_reference(const std::vector<SurfaceSamples>& layers,
                                 const ReferenceLights& lights, const ReferenceOptions& options);

}  // namespace kilolux
