// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shading/shade.h"

#include "host/stages/shading/instruction_counts.h"

namespace kilolux {
namespace {

// PoCL 3.1 loses values across the barriers of staged work-groups one item wide, which 16 lanes
// make, and reads through a wild pointer (hard case 17). A CPU gains nothing by staging, and GPUs
// are not built with that many lanes. A staging group has a work-item for each vector of a tile.
Tuning usable(Tuning tuning, const DeviceInfo& device) {
    const int lanes = device.lane_width;
    if (lanes >= FINE_TILE || FINE_TILE_PIXELS / lanes > device.max_work_group) {
        tuning.shade_stage = 0;
    }
    return tuning;
}

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

// float4 rows of a StoredLight of kernels/device/stored_light.h.
std::size_t stored_light_rows(const KernelFeatures& features) {
    return features.spot_lights ? 3 : 2;
}

// SHADOWS of kernels/shading/sum_lights.h.
constexpr int kShadowBits = 1;
constexpr int kShadowRays = 2;

BuildOptions all_options(const ShadingResources& resources, const KernelFeatures& features,
                         const SurfaceFeatures& surfaces, const Tuning& tuning) {
    BuildOptions options = resources.options();
    if (!features.shadows) return options;
    options.define("SHADOWS", kShadowRays).define("SAMPLED_SHADOWS", features.sampled_shadows);
    define_casters(options, surfaces, tuning);
    return options;
}

// Bytes of a pixel's list and of its stored surface.
double listed_surface_bytes(const StageCounts& c) {
    return (c.gbuffer_bytes_per_pixel + kPixelOrderBytes) * c.surface_pixels +
           sizeof(ActiveCluster) * c.active_clusters + c.index_bytes() * c.refined_pairs;
}

}  // namespace

ShadingResources::ShadingResources(const Gpu& gpu, const Tuning& tuning,
                                   const KernelFeatures& features)
    : gpu_(gpu),
      tuning_(usable(tuning, gpu.info)),
      features_(features),
      radiance_(gpu, kShadeStage),
      stored_(gpu, kShadeStage) {
    if (features.half_light_colors) {
        store_lights_.emplace(gpu, build_program(gpu, "store_lights", options()), kShadeStage,
                              "store_lights");
    }
}

BuildOptions ShadingResources::options() const {
    BuildOptions options = feature_options(features_)
                               .define("STAGE", tuning_.shade_stage)
                               .define("PREFETCH", tuning_.shade_prefetch)
                               .define("FAST_RSQRT", !gpu_.info.is_cpu)
                               .define("NATIVE_MATH", features_.native_math)
                               .define("HALF_LIGHT_COLORS", features_.half_light_colors);
    if (features_.fast_relaxed_math) options.flag("-cl-fast-relaxed-math");
    return options;
}

WorkSize ShadingResources::work_size(const Kernel& kernel, const View& view) const {
    if (tuning_.shade_stage == 0) return kernel.pixel_items(view, tuning_.shade_rows);
    const WorkSize size = kernel.pixel_items(view, FINE_TILE);
    if (size.local.get()[1] < FINE_TILE) {
        throw Error(std::string(kShadeStage) +
                    ": staging lights needs a work-item for each vector of a tile in a group, more "
                    "than the device allows this kernel: measure a tuning without (kilolux bench "
                    "--tune)");
    }
    return size;
}

PreparedLights ShadingResources::stored_lights(const PreparedLights& lights, StageTimer& timer) {
    if (!store_lights_ || lights.rows() == 0) return lights;
    const DeviceArray<float4> stored =
        stored_.reserve(lights.rows() * stored_light_rows(features_));
    store_lights_->enqueue({cl::NDRange(lights.rows()), cl::NullRange}, timer, lights.lights,
                           stored);
    PreparedLights out = lights;
    out.lights = DeviceArray<ShadeLight>(stored.buffer(), lights.rows());
    return out;
}

Radiance ShadingResources::radiance(const View& view) {
    return {radiance_.reserve(std::size_t{3} * view.stride * view.height), view};
}

DrawShadows::DrawShadows(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : resources_(gpu, tuning, features),
      program_(build_program(gpu, kDrawShadowsStage, resources_.options())),
      clear_(gpu, program_, kDrawShadowsStage, "draw_shadows_clear"),
      draw_(gpu, program_, kDrawShadowsStage, "draw_shadows") {}

void DrawShadows::enqueue(const LitPixels& lit, const ShadowWords& words,
                          const ShadowSamples& samples, StageTimer& timer) {
    constexpr std::size_t kClearItems = 16384;
    clear_.enqueue(items(kClearItems, 1), timer, words, lit.clusters.tile_count);
    LitPixels stored = lit;
    stored.lights = resources_.stored_lights(lit.lights, timer);
    draw_.enqueue(resources_.work_size(draw_, lit.gbuffer.view), timer, stored, words, samples);
}

Shade::Shade(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features)
    : gpu_(gpu),
      features_(features),
      resources_(gpu, tuning, features),
      variance_(gpu, kShadeStage) {}

void Shade::build(std::optional<int> tone_curve) {
    if (kernels_.contains(tone_curve)) return;
    BuildOptions options = resources_.options()
                               .define("SHADOWS", features_.shadows ? kShadowBits : 0)
                               .define("SAMPLED_SHADOWS", features_.sampled_shadows);
    if (tone_curve) options.define("DISPLAYED", 1).define("TONE_CURVE", *tone_curve);
    kernels_.try_emplace(tone_curve, gpu_, build_program(gpu_, kShadeStage, options), kShadeStage,
                         "shade");
}

Radiance Shade::enqueue(const LitPixels& lit, StageTimer& timer, const ShadowWords& shadows,
                        const ShadowSamples& samples, const std::optional<DisplayTarget>& display) {
    const std::optional<int> tone_curve =
        display ? std::optional(display->tone_curve) : std::nullopt;
    build(tone_curve);
    Kernel& kernel = kernels_.at(tone_curve);
    const View& view = lit.gbuffer.view;
    ShadingOutput out{ambient_, {}, {}};
    if (display) {
        out.display = *display;
    } else {
        out.radiance = resources_.radiance(view).planes;
    }
    if (features_.sampled_shadows)
        out.variance = variance_.reserve(std::size_t{view.stride} * view.height);
    LitPixels stored = lit;
    stored.lights = resources_.stored_lights(lit.lights, timer);
    kernel.enqueue(resources_.work_size(kernel, view), timer, stored, shadows, samples, out);
    return {out.radiance, view};
}

ShadeAll::ShadeAll(const Gpu& gpu, const Tuning& tuning, const KernelFeatures& features,
                   const SurfaceFeatures& surfaces)
    : resources_(gpu, tuning, features),
      kernel_(gpu,
              build_program(gpu, "shade_all", all_options(resources_, features, surfaces, tuning)),
              kShadeStage, "shade_all"),
      samples_shadows_(features.sampled_shadows),
      variance_(gpu, kShadeStage) {}

Radiance ShadeAll::enqueue(const GBuffer& gbuffer, const PreparedLights& lights, StageTimer& timer,
                           const ShadowInput& shadows, const ShadowSamples& samples) {
    const View& view = gbuffer.view;
    ShadingOutput out{ambient_, resources_.radiance(view).planes, {}};
    if (samples_shadows_) out.variance = variance_.reserve(std::size_t{view.stride} * view.height);
    kernel_.enqueue(resources_.work_size(kernel_, view), timer, gbuffer,
                    resources_.stored_lights(lights, timer), shadows, samples, out);
    return {out.radiance, view};
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

// Evaluates each light of a pixel's list alone.
StageWork draw_shadows_work(const StageCounts& c) {
    return {.bytes_read = listed_surface_bytes(c) + kRadianceBytes * c.surface_pixels,
            .bytes_written = kWordBytes * c.shadow_words,
            .instructions = shading_instructions(c),
            .launches = 2};
}

}  // namespace kilolux
