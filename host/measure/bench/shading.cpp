// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench/shading.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <set>

#include "host/base/gbuffer_layout.h"
#include "host/measure/roofline/limit_kernels.h"
#include "host/measure/roofline/roofline.h"
#include "host/render/kernel_choice.h"
#include "host/scene/camera.h"
#include "host/stages/shade.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr int kModels[] = {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR};
constexpr const char* kModelNames[] = {"lambert", "blinn-phong", "pbr"};
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
    for (const int model : kModels) {
        for (const int lanes : lane_widths(device)) {
            KernelFeatures features;
            features.shading = model;
            ShadingMeasurement measurement;
            measurement.model = kModelNames[model];
            measurement.lanes = lanes;
            const Gpu lanes_gpu = gpu.with_lanes(lanes);
            variants.push_back({measurement, features, ShadeAll(lanes_gpu, tuning, features), {}});
            variants.back().shade.set_ambient(settings.ambient);
        }
    }
    return variants;
}

void set_limits(Variant& variant, const View& view, const DeviceLimits& limits) {
    ShadingMeasurement& m = variant.measurement;
    StageCounts counts;
    counts.pixels = counts.drawn_pixels = static_cast<double>(view.width) * view.height;
    counts.lights = kShadingLights;
    counts.evaluations = counts.full_evaluations = counts.pixels * kShadingLights;
    counts.kernels = variant.features;
    StageWork work = stage_work("shade", counts).value();
    const StageLimit limit = stage_limit(work, limits);
    m.limit_ms = limit.ms;
    m.bound = bound_name(limit.bound);
    m.evaluations = counts.evaluations;
    m.bytes = work.bytes_read + work.bytes_written;
    m.instruction_ms = 1e3 * work.instructions.total / (0.5 * limits.fma_flops);
}

// The least time of the same model with one lane.
double one_lane_ms(const std::vector<Variant>& variants, const std::string& model) {
    for (const Variant& variant : variants) {
        if (variant.measurement.model == model && variant.measurement.lanes == 1) {
            return variant.measurement.ms.min;
        }
    }
    return 0.0;
}

}  // namespace

int shading_variants(const RenderSettings& settings) {
    const DeviceInfo device = describe(choose_device(settings.device));
    return static_cast<int>(std::size(kModels) * lane_widths(device).size());
}

std::vector<ShadingMeasurement> measure_shading(const RenderSettings& settings, DeviceLimits limits,
                                                int runs, const std::function<void()>& on_run) {
    return in_stage("shading bench", [&] {
        const Gpu gpu = open_device(settings);
        const GBuffer gbuffer =
            make_gbuffer(gpu, view_of(Camera{}, settings.width, settings.height));
        const PreparedLights lights = make_lights(gpu);
        std::vector<Variant> variants = make_variants(gpu, settings);
        LimitKernels limit_kernels(gpu.with_lanes(gpu.info.vector_width));
        for (int run = -1; run < runs; ++run) {
            raise_arithmetic_limits(limits, limit_kernels);
            for (Variant& variant : variants) {
                StageTimer timer;
                variant.shade.enqueue(gbuffer, lights, timer);
                const double ms = timer.take().front().ms;
                if (run >= 0) variant.times_ms.push_back(ms);  // the first one warms up
                on_run();
            }
        }
        std::vector<ShadingMeasurement> out;
        for (Variant& variant : variants) {
            variant.measurement.ms = statistics(variant.times_ms);
            set_limits(variant, gbuffer.view, limits);
        }
        for (const Variant& variant : variants) {
            out.push_back(variant.measurement);
            const double ms = variant.measurement.ms.min;
            out.back().speed_up =
                ms > 0.0 ? one_lane_ms(variants, variant.measurement.model) / ms : 0.0;
        }
        return out;
    });
}

Table shading_table(const std::vector<ShadingMeasurement>& measurements) {
    Table table;
    table.columns = {"model",      "lanes",         "n",     "median [ms]",       "least [ms]",
                     "limit [ms]", "ratio",         "bound", "instruction ratio", "Geval/s",
                     "GB/s",       "times one lane"};
    for (const ShadingMeasurement& m : measurements) {
        const double per_ms = m.ms.min > 0.0 ? 1e-6 / m.ms.min : 0.0;
        table.rows.push_back({m.model, std::int64_t{m.lanes}, static_cast<std::int64_t>(m.ms.count),
                              m.ms.median, m.ms.min, m.limit_ms, m.ratio(), m.bound,
                              m.instruction_ratio(), m.evaluations * per_ms, m.bytes * per_ms,
                              m.speed_up});
    }
    return table;
}

}  // namespace kilolux
