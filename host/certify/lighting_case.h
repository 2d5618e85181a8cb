// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/certify/findings.h"
#include "host/certify/synthetic/host_lists.h"
#include "host/certify/synthetic/synthetic.h"
#include "host/measure/reference/reference.h"

namespace kilolux {

inline constexpr double kUlp = 0x1p-24;  // u: half a unit in the last place of 1

/// The input of the lighting kernels: a G-buffer made in memory, a grid and lights.
struct LightingCase {
    KernelFeatures features;
    GridRequest request{6, 4, 4, 0.5f, 50.0f, 0.0f};
    Synthetic image;
    std::vector<Light> lights;                         // camera-relative
    std::vector<DirectionalLight> directional_lights;  // world axes
    float ambient = 0.0f;
};

/// A case of a view whose depth and attributes are noise.
LightingCase noise_case(const ViewShape& shape, const DepthOf& depth,
                        const KernelFeatures& features = {});

/// Every feature: any light, metals, emission, occlusion and what dielectrics reflect.
KernelFeatures every_feature(int shading);

/// Leaves light from lights only: no ambient, no emission. The case has a material plane.
void put_out_surfaces(LightingCase& input);

/// A lit dielectric of albedo and roughness 0.5.
SurfaceSample grey_surface(const glm::dvec3& position, const glm::dvec3& normal = {0, 0, 1});

/// A case whose pixels show `surfaces` exactly (float32), row by row, `width` a row; the rest of
/// the last row is background. Positions need not lie on their pixels' rays: the grid's pad covers
/// the distance. Layout `full` with all planes; view space is world space.
LightingCase surface_case(std::span<const SurfaceSample> surfaces, int shading, uint width = 16);

/// The device's results for a case.
struct DeviceResult {
    ClusterGrid grid{};
    Planes planes;                                     // decoded
    std::vector<ShadeLight> lights;                    // view space, as shaded
    std::vector<DirectionalLight> directional_lights;  // view space
    std::vector<LightExtent> extents;                  // of the lights on the grid
    HostLists lists;
    std::vector<float> listed, all;  // radiance by lists, and by every light

    /// Radiance by lists of a pixel and channel.
    float radiance(uint x, uint y, std::size_t channel) const {
        return listed[(channel * planes.view.height + y) * planes.view.stride + x];
    }
};

/// Throws Interrupted once a signal has asked for the end.
DeviceResult light_on_device(const Gpu& gpu, const LightingCase& input);

ClusterGrid grid_of(const LightingCase& input);
LightingInput upload(const Gpu& gpu, const LightingCase& input);
std::vector<float> download(const Gpu& gpu, const Radiance& radiance);

/// Calls `visit(x, y)` for every pixel, row by row.
template <typename Visit>
void for_each_pixel(const View& view, Visit&& visit) {
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) visit(x, y);
    }
}

/// Calls `visit(x, y)` for the pixels that show a surface.
template <typename Visit>
void for_each_drawn(const LightingCase& input, Visit&& visit) {
    for_each_pixel(input.image.view, [&](uint x, uint y) {
        if (input.image.shows_surface(x, y)) visit(x, y);
    });
}

/// "pixel 3, 4".
std::string at_pixel(uint x, uint y);

/// Values that are not 0.
std::uint64_t count_lit(const std::vector<float>& values);
/// Values that are NaN, infinite or negative.
std::uint64_t count_invalid(const std::vector<float>& values);

/// The largest of `error(x, y)` over the pixels that show a surface.
template <typename Error>
Worst worst_of_drawn(const LightingCase& input, Error&& error) {
    Worst worst;
    for_each_drawn(input,
                   [&](uint x, uint y) { worst.add(error(x, y), [&] { return at_pixel(x, y); }); });
    return worst;
}

/// Floats of two pictures whose bits differ; sizes must be equal.
Worst different_bits(const std::vector<float>& a, const std::vector<float>& b);
void check_same_bits(Findings& findings, std::string_view what, const std::vector<float>& a,
                     const std::vector<float>& b);

/// Checks that radiance by lists has the bits of radiance by every light, and background is 0.
void check_exact(Findings& findings, const LightingCase& input, const DeviceResult& result);

/// Checks that of `pixel_limit` surface pixels, no light with float64 distance below its range is
/// missing from the pixel's list. Returns how many (pixel, light) pairs reach.
std::uint64_t check_none_missing(Findings& findings, const LightingCase& input,
                                 const DeviceResult& result, std::size_t pixel_limit = 400);

/// Both checks, with at least `least_pairs` pairs that reach. Returns the result.
DeviceResult check_lists(Findings& findings, const Gpu& gpu, const LightingCase& input,
                         std::uint64_t least_pairs = 1000);

/// |x - r| / max(r, E) against R1, the float64 sum over the decoded surfaces and float32 lights.
Worst error_against_r1(const LightingCase& input, const DeviceResult& result);

/// Surfaces as the kernels decode them, and the reference picture over them.
SurfaceSamples decoded_surfaces(const LightingCase& input, const DeviceResult& result);
ReferencePicture r1_picture(const LightingCase& input, const DeviceResult& result);

/// Of the lights that surface pixels list (k), the share that is within range by float64 (k*).
double useful_share(const LightingCase& input, const DeviceResult& result);

}  // namespace kilolux
