// SPDX-License-Identifier: Apache-2.0
#include "present/python/gbuffer_lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "host/base/error.h"
#include "host/base/formats/gbuffer_layout.h"
#include "host/lighting/deferred_lighting.h"
#include "host/render/lights/light_rows.h"
#include "host/scene/lights/bounded_loss.h"
#include "host/stages/lists/build_clusters.h"
#include "host/stages/lists/count_lights.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

int shading_of(const std::string& name) {
    if (name == "lambert") return SHADING_LAMBERT;
    if (name == "blinn-phong") return SHADING_BLINN_PHONG;
    if (name == "pbr") return SHADING_PBR;
    throw Error("shading '" + name + "' is none of lambert, blinn-phong, pbr");
}

// Distances from the nearest surface to the farthest [m].
struct DepthRange {
    float first = 1.0f, last = 1.0f;
};

DepthRange range_of(const std::vector<float>& depth) {
    DepthRange range{INFINITY, 0.0f};
    for (const float z : depth) {
        if (!(z > 0.0f) || !std::isfinite(z)) continue;
        range = {std::min(range.first, z), std::max(range.last, z)};
    }
    return range.last > 0.0f ? range : DepthRange();
}

void check(const HostSurfaces& s) {
    const auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
    const auto require = [pixels](const char* what, const std::vector<float>& values,
                                  std::size_t channels) {
        if (values.size() == channels * pixels) return;
        throw Error(fmt::format("G-buffer: {} has {} values, must have {}", what, values.size(),
                                channels * pixels));
    };
    if (pixels == 0) throw Error("G-buffer: depth has no pixels");
    require("depth", s.depth, 1);
    require("normal", s.normal, 3);
    require("albedo", s.albedo, 3);
    require("roughness", s.roughness, 1);
    if (!s.metallic.empty()) require("metallic", s.metallic, 1);
    if (!s.emissive.empty()) require("emissive", s.emissive, 3);
}

// A read-only copy on the device; no buffer is empty.
template <typename T>
cl::Buffer device_copy(const Gpu& gpu, const std::vector<T>& values) {
    const std::size_t bytes = std::max(values.size() * sizeof(T), std::size_t{16});
    cl::Buffer buffer(gpu.context, CL_MEM_READ_ONLY, bytes);
    upload(gpu, buffer, std::span<const T>(values));
    return buffer;
}

// The float32 layout's planes in one buffer.
class FullPlanes {
 public:
    FullPlanes(const HostSurfaces& surfaces, const View& view, const SceneFeatures& features)
        : surfaces_(surfaces),
          view_(view),
          layout_(full_gbuffer_layout(features, view.stride, view.height)),
          bytes_(gbuffer_bytes(layout_, view.stride, view.height)) {}

    void fill(float z_near) {
        for (uint y = 0; y < view_.height; ++y) {
            for (uint x = 0; x < view_.width; ++x) fill_pixel(x, y, z_near);
        }
    }

    GBuffer upload(const Gpu& gpu) const { return {device_copy(gpu, bytes_), layout_, view_}; }

 private:
    void put(uint plane, std::size_t pixel, float value) {
        if (layout_.offset_bytes[plane] == PLANE_ABSENT) return;
        reinterpret_cast<float*>(&bytes_[layout_.offset_bytes[plane]])[pixel] = value;
    }

    void put(uint plane, std::size_t pixel, const FV3& v) {
        put(plane, pixel, v.x);
        put(plane + 1, pixel, v.y);
        put(plane + 2, pixel, v.z);
    }

    void fill_pixel(uint x, uint y, float z_near) {
        const std::size_t from = std::size_t{y} * view_.width + x;
        const std::size_t to = std::size_t{y} * view_.stride + x;
        const float z = surfaces_.depth[from];
        if (!(z > 0.0f) || !std::isfinite(z)) return;  // depth01 0: background
        const auto three = [from](const std::vector<float>& v) {
            return fv3(v[3 * from], v[3 * from + 1], v[3 * from + 2]);
        };
        const FV3 n = three(surfaces_.normal);
        const auto along = [&n](const float4& row) {
            return row.x * n.x + row.y * n.y + row.z * n.z;
        };
        put(PLANE_DEPTH, to, z_near / z);
        put(PLANE_POSITION_X, to,
            view_position(view_, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z));
        put(PLANE_NORMAL_X, to,
            fv3(along(view_.view_from_world_x), along(view_.view_from_world_y),
                along(view_.view_from_world_z)));
        put(PLANE_ALBEDO_R, to, three(surfaces_.albedo));
        put(PLANE_ROUGHNESS, to, surfaces_.roughness[from]);
        if (!surfaces_.metallic.empty()) put(PLANE_METALLIC, to, surfaces_.metallic[from]);
        if (!surfaces_.emissive.empty()) put(PLANE_EMISSIVE_R, to, three(surfaces_.emissive));
    }

    const HostSurfaces& surfaces_;
    View view_;
    GBufferLayout layout_;
    std::vector<std::byte> bytes_;
};

KernelFeatures features_of(const HostSurfaces& surfaces, const LightRows& rows, int shading) {
    KernelFeatures features{rows.features};
    features.shading = shading;
    features.gbuffer = GBUFFER_FULL;
    features.point_lights = true;
    features.metallic = !surfaces.metallic.empty();
    features.emissive = !surfaces.emissive.empty();
    features.material = features.metallic || features.emissive;
    features.gloss = shading != SHADING_LAMBERT;
    features.wide_light_index = rows.local.size() > 65536;
    features.light_index_bits = features.wide_light_index ? 32 : 16;
    return features;
}

// A box in the world around all that a perspective camera sees at these depths.
Box box_of(const Camera& camera, double aspect, const DepthRange& range) {
    const double tangent = std::tan(0.5 * camera.y_fov);
    Box out;
    for (const double z : {double{range.first}, double{range.last}}) {
        for (const double x : {-z, z}) {
            for (const double y : {-z, z}) {
                const glm::dvec3 in_view(x * aspect * tangent, y * tangent, -z);
                out.add(camera.position + camera.world_from_view * in_view);
            }
        }
    }
    return out;
}

// Rows of `channels` planes with a stride, interleaved without it.
template <typename T>
std::vector<T> without_padding(const std::vector<T>& planes, const View& view,
                               std::size_t channels) {
    const std::size_t plane = std::size_t{view.stride} * view.height;
    std::vector<T> out;
    out.reserve(channels * view.width * view.height);
    for (std::size_t y = 0; y < view.height; ++y) {
        for (std::size_t x = 0; x < view.width; ++x) {
            for (std::size_t c = 0; c < channels; ++c) {
                const T value = planes[c * plane + y * view.stride + x];
                out.push_back(value);
            }
        }
    }
    return out;
}

}  // namespace

GBufferLighting::GBufferLighting(const std::string& device, const std::string& shading)
    : GBufferLighting(choose_device(device), shading_of(shading)) {}

GBufferLighting::GBufferLighting(const cl::Device& device, int shading)
    : known_(known_tuning(describe(device))), gpu_(device, known_.lanes), shading_(shading) {}

GBufferLighting::Lit GBufferLighting::light(const HostSurfaces& surfaces, const Camera& seen_by,
                                            std::vector<SceneLight> lights, float ambient) {
    check(surfaces);
    const std::scoped_lock lock(mutex_);
    const DepthRange range = range_of(surfaces.depth);
    Camera camera = seen_by;
    camera.z_near = range.first;
    const View view = view_of(camera, surfaces.width, surfaces.height);
    const Tails tails = tails_for(lights, Tails::automatic, kDefaultRangeBudget);
    const double aspect = double(surfaces.width) / surfaces.height;
    fill_missing_ranges(lights, tails,
                        tails == Tails::bounded
                            ? budget_of_sum(lights, box_of(camera, aspect, range))
                            : kDefaultRangeBudget);
    const LightRows rows = make_light_rows(lights, camera.position);
    const KernelFeatures features = features_of(surfaces, rows, shading_);
    FullPlanes planes(surfaces, view, features);
    planes.fill(range.first);
    const GBuffer gbuffer = planes.upload(gpu_);
    const LightInput input{device_copy(gpu_, rows.local), static_cast<uint>(rows.local.size()),
                           device_copy(gpu_, rows.directional),
                           static_cast<uint>(rows.directional.size())};
    const ClusterGrid grid = make_cluster_grid(
        {.z_first = range.first, .z_last = range.last, .position_pad = 1e-5f * range.last},
        view.width, view.height);
    const Tuning& tuning = known_.tuning;
    StageTimer timer;
    DeferredLighting lighting(gpu_, tuning, features);
    lighting.set_ambient(ambient);
    const Radiance radiance = lighting.light({gbuffer, input, grid}, timer);
    CountLights count(gpu_, tuning, features);
    const LightCounts counts = count.enqueue(lighting.lists().at(gbuffer), timer);
    Lit out{without_padding(download(gpu_, radiance.planes), view, 3),
            without_padding(download(gpu_, counts.evaluated), view, 1),
            without_padding(download(gpu_, counts.covering), view, 1)};
    for (std::vector<uint>* plane : {&out.evaluated, &out.covering}) {
        std::replace(plane->begin(), plane->end(), ~0u, 0u);
    }
    return out;
}

}  // namespace kilolux
