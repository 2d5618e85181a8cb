// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/shade.h"

#include "host/stages/shading/instruction_counts.h"

namespace kilolux {
namespace {

// The ambient light that shading adds, and its output buffers: OUTPUT_ARGS.
struct ShadingOutput {
    float ambient;
    DeviceArray<float> radiance, variance;
    DisplayTarget display{};

    void each(auto&& set) const {
        set("ambient", ambient);
        set("radiance", radiance);
        set("variance", variance);
        set(display);
    }
};

// SHADOWS of kernels/shading/light_set.h.
constexpr int kShadowBits = 1;
constexpr int kShadowRays = 2;

// With some shadows. `way`: kShadow*.
BuildOptions shadow_options(BuildOptions options, int way, const KernelFeatures& features,
                            SurfaceFeatures surfaces, const Tuning& tuning) {
    options.define("SHADOWS", way).define("SAMPLED_SHADOWS", features.sampled_shadows);
    if (features.tinted_shadows) {
        options.define("TINTED_SHADOWS", 1);
        surfaces.anisotropy = 1;
    }
    if (way == kShadowRays || features.tinted_shadows) {
        define_casters(options, surfaces, tuning);
    }
    return options;
}

}  // namespace

Shade::Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
             const SurfaceFeatures& surfaces, bool candidates)
    : tuning_(tuning),
      features_(features),
      surfaces_(surfaces),
      candidates_(candidates),
      resources_(gpu, tuning, features, kShadeStage),
      variance_(gpu, kShadeStage) {}

void Shade::build(std::optional<int> tone_curve) {
    if (kernels_.contains(tone_curve)) return;
    BuildOptions options = resources_.options();
    if (candidates_) options.define("MARK_CANDIDATES", 1);
    if (features_.shadows) {
        options = shadow_options(options, kShadowBits, features_, surfaces_, tuning_);
    }
    if (tone_curve) options.define("DISPLAYED", 1).define("TONE_CURVE", *tone_curve);
    const Gpu& gpu = resources_.gpu();
    kernels_.try_emplace(tone_curve, gpu, build_program(gpu, kShadeStage, options), kShadeStage,
                         "shade");
}

Radiance Shade::enqueue(const LitPixels& lit, StageTimer& timer, const SeenInput& seen,
                        const std::optional<DisplayTarget>& display) {
    const std::optional<int> tone_curve =
        display ? std::optional(display->tone_curve) : std::nullopt;
    build(tone_curve);
    Kernel& kernel = kernels_.at(tone_curve);
    const View& view = lit.gbuffer.view;
    ShadingOutput out{ambient_, {}, {}};
    Radiance light{{}, view};
    if (display) {
        out.display = *display;
    } else {
        light = resources_.radiance(view);
        out.radiance = light.planes;
    }
    if (features_.sampled_shadows)
        out.variance = variance_.reserve(std::size_t{view.stride} * view.height);
    LitPixels stored = lit;
    stored.lights = resources_.stored_lights(lit.lights, timer);
    const auto items = resources_.work_size(kernel, view);
    if (features_.tinted_shadows) {
        kernel.enqueue(items, timer, stored, seen.words, seen.tints, seen.samples, out);
    } else {
        kernel.enqueue(items, timer, stored, seen.words, seen.samples, out);
    }
    return light;
}

ShadeAll::ShadeAll(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                   const SurfaceFeatures& surfaces)
    : resources_(gpu, tuning, features, kShadeStage),
      kernel_(gpu,
              build_program(resources_.gpu(), "shade_all",
                            features.shadows ? shadow_options(resources_.options(), kShadowRays,
                                                              features, surfaces, tuning)
                                             : resources_.options()),
              kShadeStage, "shade_all"),
      samples_shadows_(features.sampled_shadows),
      variance_(gpu, kShadeStage) {}

Radiance ShadeAll::enqueue(const GBuffer& gbuffer, const PreparedLights& lights, StageTimer& timer,
                           const ShadowInput& shadows, const ShadowSamples& samples) {
    const View& view = gbuffer.view;
    const Radiance light = resources_.radiance(view);
    ShadingOutput out{ambient_, light.planes, {}};
    if (samples_shadows_) out.variance = variance_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(resources_.work_size(kernel_, view), timer, gbuffer,
                    resources_.stored_lights(lights, timer), shadows, samples, out);
    return light;
}

// Sampled shadows shade twice: with all lights, and without hidden ones that were picked.
StageWork shade_work(const StageCounts& c) {
    StageWork work{.bytes_read = listed_surface_bytes(c),
                   .bytes_written = kRadianceBytes * c.pixels,
                   .instructions = shading_instructions(c),
                   .launches = 1,
                   .evaluations = full_evaluations(c)};
    const double words = c.all_lights ? 0.0 : kWordBytes * c.shadow_words;
    if (c.kernels.shadows && !c.kernels.sampled_shadows) {
        work.bytes_read += words;
        work.instructions = seen_instructions(c);
        work.evaluations = c.shadow_seen;
    } else if (c.kernels.shadows) {
        work.bytes_read = 2.0 * work.bytes_read + words + kRadianceBytes * c.surface_pixels;
        work.bytes_written = 2.0 * work.bytes_written + sizeof(float) * c.pixels;
        work.instructions = 2.0 * work.instructions;
        work.launches = 2;
    }
    if (c.shaded_display) work.bytes_written += (kDisplayBytes - kRadianceBytes) * c.pixels;
    return work;
}

}  // namespace kilolux
