// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/picture/frame.h"
#include "host/picture/web_in_view.h"
#include "kernels/shared/area/area_shape.h"
#include "kernels/shared/cluster_grid.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"

namespace kilolux {

/// Mean of the counts that are not background's ~0; 0 if there are none.
double mean_over_surfaces(const std::vector<uint>& counts);

/// The count of lights at background pixels.
constexpr uint kBackground = ~0u;

/// A decoded G-buffer on the host, with what is known of each pixel's lights.
struct DecodedSurfaces {
    /// Bytes of a pixel, without planes that only some AOVs have: surface and counts.
    static constexpr std::size_t kPixelBytes = SURFACE_PLANES * sizeof(float) + 2 * sizeof(uint);

    View view{};
    std::vector<float> planes;    // [SURFACE_PLANES][height][stride]
    std::vector<uint> evaluated;  // [height][stride] k: lights evaluated at the pixel; kBackground
    std::vector<uint> covering;   // [height][stride] k*: those that reach it; empty if not counted
    // [height][stride] with shadows: lights that the pixel faces within their range, and those of
    // them that it sees; empty if not counted.
    std::vector<uint> facing, seen;
    // [height][stride]: the estimated variance of the luminance; empty if not known.
    std::vector<float> variance;
    // [3][height][stride]: a bound of the radiance that ranges take from lights without one of
    // their own; empty if not asked for.
    std::vector<float> bound;
    // [3][height][stride]: illuminance [lx]; empty if not asked for.
    std::vector<float> illuminance;
    // With groups of lights, the planes of a Radiance: the light of the picture's pixels, and the
    // part of it from each group.
    std::vector<float> light;
    std::vector<uint> layers;  // [height][stride]: that blend; empty if not counted
    std::vector<uint> taken;   // [height][stride] samples; empty where their number was given
    ClusterGrid grid{};
    bool unlit = false;  // whether a roughness of 0 means an unlit surface

    /// A value of a plane, and of three planes from `plane` on, at an index within it.
    float at(std::size_t plane, std::size_t pixel) const {
        return planes[plane * view.stride * view.height + pixel];
    }
    glm::dvec3 vector(std::size_t plane, std::size_t pixel) const {
        return {at(plane, pixel), at(plane + 1, pixel), at(plane + 2, pixel)};
    }
    bool shows_surface(std::size_t pixel) const { return at(SURFACE_DEPTH, pixel) != 0.0f; }
};

/// The luminance of a colour of linear Rec. 709, as a share of white's.
double luminance_of(const glm::dvec3& color);

/// Illuminance at pixel `i` of the planes [lx].
double illuminance_at(const DecodedSurfaces& surfaces, std::size_t i);

/// The surfaces and lights of a picture that was shaded, on the host.
struct LitSurfaces {
    DecodedSurfaces surfaces;
    std::vector<ShadeLight> lights;             // view space
    std::vector<DirectionalLight> directional;  // view space
    std::vector<WebInView> webs;                // one per light, or none at all
    std::vector<LightShape> shapes;             // view space; one per light, or none at all
};

/// The coarse cluster of the pixel at an index of the planes; none for background.
std::optional<uint> coarse_cluster_at(const DecodedSurfaces& surfaces, std::size_t pixel);

/// The share of the lights that pixel `i` of the planes faces within their range which something
/// hides; 0 where there are none.
double hidden_share(const DecodedSurfaces& surfaces, std::size_t i);

}  // namespace kilolux
