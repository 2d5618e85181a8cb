// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/certify/findings.h"
#include "host/certify/synthetic/light_sets.h"
#include "host/certify/synthetic/stage_run.h"
#include "host/certify/synthetic/synthetic.h"
#include "host/measure/reference/reference.h"

namespace kilolux {

/// What the kernels are given: a G-buffer made up in memory, a grid and lights.
struct Shot {
    KernelFeatures features;
    GridRequest request{6, 4, 4, 0.5f, 50.0f, 0.0f};
    Synthetic image;
    std::vector<Light> lights;             // camera-relative
    std::vector<DirectionalLight> suns{};  // world axes
    float ambient = 0.0f;
};

/// A shot of a view whose depth and attributes are noise.
Shot noise_shot(const ViewShape& shape, const DepthOf& depth, const KernelFeatures& features = {});

/// Features that compile in all there is: any light, metals, emission and occlusion.
KernelFeatures every_feature(int shading);

/// Leaves only light from lights: no ambient, no emission. The shot has a material plane.
void put_out_surfaces(Shot& shot);

/// A shot whose pixels show `surfaces` exactly (float32), row by row, `width` a row; what is left
/// of the last row is background. Positions need not lie on their pixels' rays: the grid's pad
/// takes that up. Layout `full` with material and occlusion planes; view space is world space.
Shot surface_shot(std::span<const SurfaceSample> surfaces, int shading, uint width = 16,
                  bool orthographic = false);

/// What the device made of a shot.
struct Exposure {
    ClusterGrid grid{};
    Planes planes;                       // decoded
    std::vector<ShadeLight> lights;      // view space, as shaded
    std::vector<DirectionalLight> suns;  // view space
    std::vector<LightExtent> extents;    // of the lights on the grid
    HostLists lists;
    std::vector<float> listed, all;  // radiance by lists, and by every light
};

Exposure expose(const Gpu& gpu, const Shot& shot, const Tuning& tuning);
Exposure expose(const Gpu& gpu, const Shot& shot);

/// Whether the pixel shows a surface.
bool is_drawn(const Shot& shot, uint x, uint y);

/// "pixel 3, 4".
std::string at_pixel(uint x, uint y);

/// Floats of two pictures whose bits differ; sizes must be equal.
Worst different_bits(const std::vector<float>& a, const std::vector<float>& b);

/// "exact": radiance by lists has the bits of radiance by every light, and background is 0.
void check_exact(Findings& findings, const Shot& shot, const Exposure& exposure);

/// "conservative": of `pixel_limit` drawn pixels, no light with float64 distance below its range is
/// missing from the pixel's list. Returns how many (pixel, light) pairs reach.
std::uint64_t check_none_missing(Findings& findings, const Shot& shot, const Exposure& exposure,
                                 std::size_t pixel_limit = 400);

/// |x - r| / max(r, E) against R1, the float64 sum over the decoded surfaces and float32 lights.
Worst error_against_r1(const Shot& shot, const Exposure& exposure);

/// Surfaces as the kernels decode them, and the reference picture over them.
SurfaceSamples decoded_surfaces(const Shot& shot, const Exposure& exposure);
ReferencePicture r1_picture(const Shot& shot, const Exposure& exposure);

/// Mean lights per drawn pixel: listed (k), and by float64 within range (k*).
struct LightsPerPixel {
    double listed = 0.0;
    double reaching = 0.0;
};
LightsPerPixel lights_per_pixel(const Shot& shot, const Exposure& exposure);

/// Both "conservative" and "exact", with at least `least_pairs` pairs that reach.
void check_lists(Findings& findings, const Gpu& gpu, const Shot& shot,
                 std::uint64_t least_pairs = 1000);

}  // namespace kilolux
