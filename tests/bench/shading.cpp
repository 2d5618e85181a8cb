// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/shading.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <set>

#include "host/base/formats/gbuffer_layout.h"
#include "host/measure/roofline/limit_kernels.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/plan/kernel_choice.h"
#include "host/scene/camera.h"
#include "host/stages/shading/shade.h"

namespace kilolux {
namespace {

constexpr float kNearest = 2.0f, kFarthest = 20.0f;  // of the pixels [m]
constexpr float kRange = 100.0f;                     // of the lights [m]

std::set<int> lane_widths(const DeviceInfo& device) {
    return {1, 2, 4, 8, 16, device.vector_width};
}

// Numbers in [0, 1), the same on every machine.
class Noise {
 public:
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }

 private:
    std::mt19937 engine_{1};
};

// Planes of noise without background pixels.
GBuffer make_gbuffer(const Gpu& gpu, const View& view) {
    GBuffer out;
    out.view = view;
    out.layout = make_gbuffer_layout(GBufferNeeds{}, view.stride, view.height);
    std::vector<std::byte> bytes(gbuffer_bytes(out.layout, view.stride, view.height));
    const auto set = [&](uint plane, std::size_t pixel, auto value) {
        std::memcpy(bytes.data() + out.layout.offset_bytes[plane] + pixel * sizeof value, &value,
                    sizeof value);
    };
    Noise noise;
    const std::size_t pixels = std::size_t{view.stride} * view.height;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const float z = kNearest + (kFarthest - kNearest) * noise();
        set(PLANE_DEPTH, pixel, (1.0f / z - view.depth.w) / view.depth.x);
        set(PLANE_NORMAL, pixel, noise.word());
        set(PLANE_ALBEDO, pixel, noise.word());
    }
    out.bytes = GrowingBuffer(gpu, "gbuffer").reserve(bytes.size());
    upload<std::byte>(gpu, out.bytes, bytes);
    return out;
}

// Point lights among the pixels.
PreparedLights make_lights(const Gpu& gpu) {
    Noise noise;
    std::vector<ShadeLight> lights(kShadingLights);
    for (ShadeLight& light : lights) {
        const float z = kNearest + (kFarthest - kNearest) * noise();
        light.position_inv_range2 = {z * (noise() - 0.5f), z * (noise() - 0.5f), -z,
                                     1.0f / (kRange * kRange)};
        light.color_scale = {noise(), noise(), noise(), 1.0f};
        light.axis_cos = {0.0f, 0.0f, 0.0f, -1.0f};
    }
    PreparedLights out;
    out.count = kShadingLights;
    out.lights = GrowingBuffer(gpu, "lights").reserve(lights.size() * sizeof(ShadeLight));
    out.directional = GrowingBuffer(gpu, "lights").reserve(sizeof(DirectionalLight));
    upload<ShadeLight>(gpu, out.lights, lights);
    return out;
}

// One model with one lane width.
struct Variant {
    ShadingMeasurement measurement;
    KernelFeatures features;
    ShadeAll shade;
    std::vector<double> times_ms;
};

std::vector<Variant> make_variants(const Gpu& gpu, const RenderSettings& settings) {
    const DeviceInfo device = describe(gpu.device);
    const Tuning tuning = choose_tuning(device, settings.kernels).tuning;
    std::vector<Variant> variants;
    for (int model = 0; model < static_cast<int>(std::size(kShadingNames)); ++model) {
        for (const int lanes : lane_widths(device)) {
            KernelFeatures features;
            features.shading = model;
            ShadeAll shade(gpu.with_lanes(lanes), tuning, features);
            shade.set_ambient(settings.ambient);
            ShadingMeasurement measurement;
            measurement.model = kShadingNames[model];
            measurement.lanes = lanes;
            variants.push_back({measurement, features, std::move(shade), {}});
        }
    }
    return variants;
}

// Runs every variant in turn, first once to warm up; raises the limits before each turn.
void time_variants(std::vector<Variant>& variants, const Gpu& gpu, const GBuffer& gbuffer, int runs,
                   DeviceLimits& limits, const std::function<void()>& on_run) {
    const PreparedLights lights = make_lights(gpu);
    LimitKernels limit_kernels(gpu.with_lanes(gpu.info.vector_width));
    for (int run = -1; run < runs; ++run) {
        raise_arithmetic_limits(limits, limit_kernels);
        for (Variant& variant : variants) {
            StageTimer timer;
            variant.shade.enqueue(gbuffer, lights, timer);
            const double ms = timer.take().front().ms;
            if (run >= 0) variant.times_ms.push_back(ms);
            on_run();
        }
    }
    for (Variant& variant : variants) variant.measurement.ms = statistics(variant.times_ms);
}

void set_limits(Variant& variant, const View& view, const DeviceLimits& limits) {
    ShadingMeasurement& m = variant.measurement;
    StageCounts counts;
    counts.pixels = counts.surface_pixels = static_cast<double>(view.width) * view.height;
    counts.lights = kShadingLights;
    counts.evaluations = counts.full_evaluations = counts.pixels * kShadingLights;
    counts.kernels = variant.features;
    const StageWork work = shade_work(counts);
    const StageLimit limit = stage_limit(work, limits);
    m.limit_ms = limit.ms;
    m.bound = bound_name(limit.bound);
    m.evaluations = counts.evaluations;
    m.bytes = work.bytes();
    m.instruction_ms = 1e3 * work.instructions.total / (0.5 * limits.fma_flops);
}

}  // namespace

int shading_variants(const RenderSettings& settings) {
    const DeviceInfo device = describe(choose_device(settings.device));
    return static_cast<int>(std::size(kShadingNames) * lane_widths(device).size());
}

std::vector<ShadingMeasurement> measure_shading(const RenderSettings& settings, DeviceLimits limits,
                                                int runs, const std::function<void()>& on_run) {
    return in_stage("shading bench", [&] {
        const Gpu gpu = open_device(settings);
        const GBuffer gbuffer =
            make_gbuffer(gpu, view_of(Camera{}, settings.width, settings.height));
        std::vector<Variant> variants = make_variants(gpu, settings);
        time_variants(variants, gpu, gbuffer, runs, limits, on_run);
        std::vector<ShadingMeasurement> out;
        double one_lane_ms = 0.0;  // each model's first variant
        for (Variant& variant : variants) {
            ShadingMeasurement& m = variant.measurement;
            set_limits(variant, gbuffer.view, limits);
            if (m.lanes == 1) one_lane_ms = m.ms.min;
            m.speed_up = ratio_of(one_lane_ms, m.ms.min);
            out.push_back(m);
        }
        return out;
    });
}

Table shading_table(const std::vector<ShadingMeasurement>& measurements) {
    using M = ShadingMeasurement;
    return make_table<M>(
        {{"model", &M::model},
         {"lanes", &M::lanes},
         {"n", [](const M& m) { return m.ms.count; }},
         {"median [ms]", [](const M& m) { return m.ms.median; }},
         {"least [ms]", [](const M& m) { return m.ms.min; }},
         {"limit [ms]", &M::limit_ms},
         {"ratio", [](const M& m) { return ratio_of(m.limit_ms, m.ms.min); }},
         {"bound", &M::bound},
         {"instruction ratio", [](const M& m) { return ratio_of(m.instruction_ms, m.ms.min); }},
         {"Geval/s", [](const M& m) { return ratio_of(1e-6 * m.evaluations, m.ms.min); }},
         {"GB/s", [](const M& m) { return ratio_of(1e-6 * m.bytes, m.ms.min); }},
         {"times one lane", &M::speed_up}},
        measurements);
}

}  // namespace kilolux
