// SPDX-License-Identifier: Apache-2.0
#include "host/lighting/kilolux_c.h"

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "host/base/error.h"
#include "host/base/version.h"
#include "host/gpu/tuning/tuning_store.h"
#include "host/lighting/deferred_lighting.h"
#include "host/stages/lights/move_lights.h"
#include "host/stages/picture/pack_radiance.h"
#include "host/stages/surfaces/repack_gbuffer.h"

namespace kilolux {
namespace {

thread_local std::string last_error;

// Checks an enumerator that C hands over.
template <typename Enum>
Enum checked(int value, int largest, const char* name) {
    if (value < 0 || value > largest) {
        throw Error("kilolux_create: " + std::string(name) + " is " + std::to_string(value) +
                    ", must be 0 to " + std::to_string(largest));
    }
    return static_cast<Enum>(value);
}

SourceFormat source_format(const kilolux_formats& f) {
    return {checked<DepthFormat>(f.depth, 2, "depth"), checked<NormalFormat>(f.normal, 2, "normal"),
            checked<AlbedoFormat>(f.albedo, 1, "albedo"), f.view_space_normals == 0, f.images != 0};
}

bool is_finite(std::span<const float> values) {
    for (const float v : values) {
        if (!std::isfinite(v)) return false;
    }
    return true;
}

// Normalises a caller's direction, whose length may differ from 1 by rounding, perhaps to halves;
// empty for any other length.
std::optional<float4> unit_of(const float (&v)[3], float w) {
    const float length = std::hypot(v[0], v[1], v[2]);
    if (!(std::abs(length - 1.0f) < 1e-2f)) return std::nullopt;  // NaN, too
    return float4{v[0] / length, v[1] / length, v[2] / length, w};
}

[[noreturn]] void refuse_light(std::size_t i, const std::string& what) {
    throw Error("kilolux_set_lights: light " + std::to_string(i) + ": " + what);
}

WorldLight row_of(const kilolux_light& light, std::size_t i) {
    const double* p = light.position;
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
        refuse_light(i, "its position is not finite");
    }
    if (!(light.range > 0.0f) || !std::isfinite(light.range)) {
        refuse_light(i, "range is " + std::to_string(light.range) + ", must be > 0 and finite");
    }
    if (!is_finite(light.intensity)) refuse_light(i, "its intensity is not finite");
    Light row = point_light_rows(
        {0, 0, 0, light.range}, {light.intensity[0], light.intensity[1], light.intensity[2], 0.0f});
    if (light.is_spot != 0) {
        const float width = light.cos_inner - light.cos_outer;
        const std::optional<float4> axis = unit_of(light.axis, light.cos_outer);
        if (!axis) refuse_light(i, "its axis is no unit vector");
        if (!(width >= 0.0f) || !(light.cos_outer > -1.0f) || !(light.cos_inner <= 1.0f)) {
            refuse_light(i, "cosines " + std::to_string(light.cos_inner) + " and " +
                                std::to_string(light.cos_outer) + " are no inner and outer ones");
        }
        row.color_scale.w = 1.0f / std::max(width, 1e-3f);
        row.axis_cos = *axis;
    }
    return world_light(point_pair(p[0], p[1], p[2]), row);
}

DirectionalLight row_of(const kilolux_directional_light& light, std::size_t i) {
    const auto refuse = [i](const char* what) {
        throw Error("kilolux_set_lights: directional light " + std::to_string(i) + ": " + what);
    };
    const std::optional<float4> to_light = unit_of(light.to_light, 0.0f);
    if (!to_light) refuse("to_light is no unit vector");
    if (!is_finite(light.illuminance)) refuse("its illuminance is not finite");
    return {*to_light, {light.illuminance[0], light.illuminance[1], light.illuminance[2], 0}};
}

ViewMatrices matrices_of(const kilolux_frame& f) {
    ViewMatrices out;
    std::copy_n(f.view, 16, out.view.begin());
    std::copy_n(f.projection, 16, out.projection.begin());
    out.width = f.width;
    out.height = f.height;
    out.depth = f.opengl_depth != 0 ? NdcDepth::minus_one_to_one : NdcDepth::zero_to_one;
    out.orthographic_hand = f.left_handed != 0 ? ViewHand::left : ViewHand::right;
    return out;
}

cl::Memory memory_of(cl_mem memory) {
    if (memory == nullptr) return {};
    return cl::Memory(memory, true);
}

// Runs `body`; what it throws becomes the return value and kilolux_error().
template <typename Body>
int guarded(Body&& body) {
    try {
        body();
        return 0;
    } catch (const cl::Error& error) {
        last_error = std::string(error.what()) + " failed with " + cl_error_name(error.err());
    } catch (const std::exception& error) {
        last_error = error.what();
    } catch (...) {
        last_error = "unknown error";
    }
    return 1;
}

}  // namespace
}  // namespace kilolux

using namespace kilolux;

// Everything between a foreign G-buffer and its radiance.
struct kilolux_lighting {
    kilolux_lighting(const Gpu& device, const KnownTuning& known, const kilolux_formats& formats)
        : gpu(device),
          tuning(known.tuning),
          repack(gpu, tuning, source_format(formats)),
          move(gpu, tuning),
          pack(gpu, tuning, checked<RadianceFormat>(formats.radiance, 2, "radiance")),
          directional_lights(gpu, "directional_lights") {
        features.shading = checked<int>(formats.shading, 2, "shading");
        lighting.emplace(gpu, tuning, features);
    }

    void set_lights(std::span<const kilolux_light> lights,
                    std::span<const kilolux_directional_light> given) {
        std::vector<WorldLight> rows;
        KernelFeatures needed = features;
        needed.point_lights = needed.spot_lights = false;
        for (const kilolux_light& light : lights) {
            rows.push_back(row_of(light, rows.size()));
            (light.is_spot != 0 ? needed.spot_lights : needed.point_lights) = true;
        }
        needed.directional_lights = !given.empty();
        needed.light_index_bits = rows.size() > 65536 ? 32 : 16;
        std::vector<DirectionalLight> parallel;
        for (const kilolux_directional_light& light : given)
            parallel.push_back(row_of(light, parallel.size()));
        if (needed != features) {
            std::optional<DeferredLighting> next(std::in_place, gpu, tuning, needed);
            lighting = std::move(next);
            features = needed;
        }
        std::ranges::copy(rows, move.stage(rows.size()).begin());
        move.upload();
        upload<DirectionalLight>(gpu, directional_lights.reserve(parallel.size()), parallel);
    }

    void light(const kilolux_frame& f) {
        StageTimer timer;
        const MatrixView camera = make_view(matrices_of(f));
        const GBuffer gbuffer = repack.enqueue(
            {memory_of(f.depth), memory_of(f.normal), memory_of(f.albedo), f.pitch}, camera, timer);
        const PointPair eye = point_pair(camera.camera[0], camera.camera[1], camera.camera[2]);
        const DeviceArray<Light> moved = move.enqueue(eye, timer);
        GridRequest request;
        if (f.nearest > 0.0f) request.z_first = f.nearest;
        if (f.farthest > 0.0f) request.z_last = f.farthest;
        const ClusterGrid grid = make_cluster_grid(request, f.width, f.height);
        lighting->set_ambient(f.ambient);
        const LightingInput input{
            gbuffer,
            {moved, static_cast<uint>(moved.count()), directional_lights.get(),
             static_cast<uint>(directional_lights.get().count())},
            grid};
        do {
            pack.enqueue(lighting->enqueue(input, timer), memory_of(f.radiance), f.radiance_pitch,
                         timer);
        } while (!lighting->fits(timer));
    }

    Gpu gpu;
    Tuning tuning;
    KernelFeatures features;
    RepackGBuffer repack;
    MoveLights move;
    PackRadiance pack;
    GrowingArray<DirectionalLight> directional_lights;
    std::optional<DeferredLighting> lighting;
};

int kilolux_create(cl_context context, cl_command_queue queue, const kilolux_formats* formats,
                   kilolux_lighting** out) {
    return guarded([&] {
        if (context == nullptr || queue == nullptr || formats == nullptr || out == nullptr)
            throw Error("kilolux_create: an argument is NULL");
        const cl::CommandQueue given(queue, true);
        const KnownTuning known =
            known_tuning(describe(cl::Device(given.getInfo<CL_QUEUE_DEVICE>())));
        const Gpu gpu(cl::Context(context, true), given, known.lanes);
        *out = std::make_unique<kilolux_lighting>(gpu, known, *formats).release();
    });
}

void kilolux_destroy(kilolux_lighting* lighting) { delete lighting; }

int kilolux_set_lights(kilolux_lighting* lighting, const kilolux_light* lights, size_t count,
                       const kilolux_directional_light* directional, size_t directional_count) {
    return guarded([&] {
        if (lighting == nullptr || (lights == nullptr && count > 0) ||
            (directional == nullptr && directional_count > 0))
            throw Error("kilolux_set_lights: an argument is NULL");
        lighting->set_lights({lights, count}, {directional, directional_count});
    });
}

int kilolux_light_frame(kilolux_lighting* lighting, const kilolux_frame* frame) {
    return guarded([&] {
        if (lighting == nullptr || frame == nullptr)
            throw Error("kilolux_light_frame: an argument is NULL");
        if (!std::isfinite(frame->ambient)) {
            throw Error("kilolux_light_frame: ambient is " + std::to_string(frame->ambient) +
                        ", must be finite");
        }
        lighting->light(*frame);
    });
}

const char* kilolux_error(void) { return kilolux::last_error.c_str(); }

const char* kilolux_version(void) {
    static const std::string text = version();
    return text.c_str();
}
