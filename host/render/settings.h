// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/picture/frame_request.h"
#include "host/scene/lights/environment.h"
#include "host/scene/lights/light_generator.h"
#include "host/scene/lights/light_mix.h"
#include "host/scene/lights/light_ranges.h"
#include "host/scene/lights/prefiltered_environment.h"
#include "kernels/shared/evaluate_modes.h"
#include "kernels/shared/gbuffer.h"

namespace kilolux {

enum class RendererKind { deferred, forward_plus, forward, deferred_all };

/// Whether OpenGL's fragments light the surfaces.
constexpr bool is_forward(RendererKind renderer) {
    return renderer == RendererKind::forward || renderer == RendererKind::forward_plus;
}

/// How surfaces get into the G-buffer: OpenGL (`ids`) or OpenCL (`compute`) draws triangle ids and
/// OpenCL makes the surfaces, or OpenGL's fragments write the planes. `automatic` is `compute`
/// where the device's tuning found it faster (Tuning::geometry) or EGL is missing, else `ids`.
enum class Geometry { automatic, ids, compute, planes };

/// Whether OpenCL makes the surfaces.
constexpr bool resolves_ids(Geometry geometry) { return geometry != Geometry::planes; }

/// Which lights a surface sees: all; or those that no triangle hides, a ray for each light of a
/// pixel's list; or, in the mean, the same from a few rays a pixel (kernels/shadows/shadow_pick.h).
enum class Shadows { off, exact, sampled };

/// `illuminance` shows what light surfaces receive, not what they reflect.
enum class Shading { automatic, lambert, blinn_phong, pbr, illuminance };

/// The SHADING_* number of a setting that is not automatic, and back.
constexpr int model_of(Shading shading) {
    return shading == Shading::illuminance ? SHADING_LAMBERT : static_cast<int>(shading) - 1;
}
constexpr Shading shading_of_model(int model) { return static_cast<Shading>(model + 1); }
static_assert(model_of(Shading::lambert) == SHADING_LAMBERT &&
              model_of(Shading::blinn_phong) == SHADING_BLINN_PHONG &&
              model_of(Shading::pbr) == SHADING_PBR);
inline constexpr const char* kShadingNames[] = {"lambert", "blinn-phong", "pbr"};  // by SHADING_*

enum class ToneCurve { none, neutral, aces, agx };

/// The coarse grid asked for; tile edges are rounded up to multiples of 16 pixels.
struct GridSettings {
    int tiles_x = 16;
    int tiles_y = 9;
    int slices_per_octave = 4;  // 1 ... 64
    /// Of active clusters, up to 64; rounded down to slices_per_octave times a power of two.
    int fine_per_octave = 16;
    bool operator==(const GridSettings&) const = default;
};

/// How shading kernels compute: as OpenCL C demands it, with -cl-fast-relaxed-math, by which
/// the compiler may order sums otherwise in each kernel, or with the device's native square roots
/// and reciprocals.
enum class MathMode { exact, fast_relaxed, native };

/// In which precision shading kernels store the colours of lights.
enum class LightColors { single, half };

/// How kernels are built and launched; 0: the tuning table's choice for the device.
struct KernelSettings {
    int lanes = 0;                    // VW: 1, 2, 4, 8, 16
    int group_height = 0;             // rows of a shading work-group
    int chunks = 0;                   // of lights in culling
    MathMode math = MathMode::exact;  // of shading; the forward renderers know only this
    LightColors light_colors = LightColors::single;  // likewise
    bool operator==(const KernelSettings&) const = default;
};

/// Each fine tile takes as many samples a pixel as it needs, in place of a fixed count.
struct AutoSamples {
    bool on = false;
    /// Standard error of the mean's luminance where a tile takes no more: over
    /// sqrt(luminance^2 + kSampleErrorFloor^2 at the exposure), root mean square over its pixels.
    float error = 0.05f;
    int most = 256;  // samples, at least kLeastAutoSamples
    bool operator==(const AutoSamples&) const = default;
};
inline constexpr float kSampleErrorFloor = 0.1f;  // of the light that shows as white
inline constexpr int kLeastAutoSamples = 8;

struct Gpu;

/// The command line's shared options: together with scene, camera and time they decide a picture.
struct RenderSettings {
    RendererKind renderer = RendererKind::deferred;
    int width = 1920;   // [pixel]
    int height = 1080;  // [pixel]
    LightOptions lights;
    Tails tails = Tails::automatic;             // for the scene's lights without a range
    double range_budget = kDefaultRangeBudget;  // of bounded and stochastic ones: range_of_light()
    uint seed = 1;                              // of stochastic tails and sampled shadows
    float tree_share = kDefaultTreeShare;       // of a tree's nodes: error over light
    uint gbuffer = GBUFFER_PACKED;
    Geometry geometry = Geometry::automatic;
    int anisotropy = 0;  // texture samples along a footprint's longer side at most, 1..16; 0: 1 on
                         // CPUs, 8 on GPUs
    bool no_reuse =
        false;  // also makes what did not change since the last frame; the bits are the same
    Shading shading = Shading::automatic;
    Shadows shadows = Shadows::off;
    bool opaque_shadows = false;  // exact ones: not of surfaces that blend or transmit
    int shadow_rays = 4;          // of sampled shadows: most rays a pixel, on average
    float ambient = 0.02f;        // radiance that falls in from everywhere
    // Seen where no surface covers a pixel; null: black. It lights no surface.
    std::shared_ptr<const Environment> background;
    // Lights surfaces by prefiltered maps, beside all other lights; null: nothing. The
    // forward renderers ignore it.
    std::shared_ptr<const PrefilteredEnvironment> reflections;
    float bloom = 0.0f;     // share of the light that blooms, 0..1
    float exposure = 0.0f;  // [EV]
    ToneCurve tone_curve = ToneCurve::neutral;
    int samples = 1;  // jittered samples a pixel
    AutoSamples auto_samples;
    FrameRequest want;  // what render() brings to the host
    // Frame::aovs ends with a layer for each, named kLightLayers + name, and one for the rest.
    std::vector<LightGroup> light_groups;
    LightMix light_mix;  // its groups need no layers
    GridSettings grid;
    KernelSettings kernels;
    std::vector<std::string>
        force_features;  // compiled in although the scene lacks them; see forceable_features()
    std::uint64_t max_memory_bytes =
        0;                  // that renderers may take in all; 0: most of what is available
    int memory_shares = 1;  // renderers that take equal parts of it
    int device_shares = 1;  // of those, renderers on the same device
    int band_rows = 0;      // made at once at most, a multiple of FINE_TILE; 0: what memory allows
    std::string device;     // name, part of it, or index; empty: the best
    // That device, open: renderers that share it build a program once. None: each opens its own.
    std::shared_ptr<const Gpu> opened;
    bool operator==(const RenderSettings&) const = default;
};

/// Whether more is read of pixels than their light.
inline bool reads_pixels(const RenderSettings& settings) {
    return settings.want.pixels() || !settings.light_groups.empty();
}

}  // namespace kilolux
