// SPDX-License-Identifier: Apache-2.0
#include "host/certify/shot.h"

#include <algorithm>
#include <bit>

#include "host/base/gbuffer_layout.h"
#include "host/certify/synthetic/probe.h"
#include "host/gpu/buffer.h"
#include "host/stages/shade.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

// A light as culling sees it, in double.
bool reaches(const ShadeLight& light, double range, Vec3d p) {
    const float4 c = light.position_inv_range2;
    const Vec3d v = p - Vec3d{c.x, c.y, c.z};
    const double d2 = dot(v, v);
    if (d2 >= range * range) return false;
    const float4 axis = light.axis_cos;
    return axis.w <= -1.0f || dot(v, Vec3d{axis.x, axis.y, axis.z}) > axis.w * std::sqrt(d2);
}

std::vector<uint> drawn_pixels(const Shot& shot) {
    const View& view = shot.image.view;
    std::vector<uint> pixels;
    for (uint i = 0; i < view.width * view.height; ++i) {
        if (is_drawn(shot, i % view.width, i / view.width)) pixels.push_back(i);
    }
    return pixels;
}

Shading model_of(int shading) {
    if (shading == SHADING_PBR) return Shading::pbr;
    return shading == SHADING_BLINN_PHONG ? Shading::blinn_phong : Shading::lambert;
}

glm::dvec3 to_glm(Vec3d v) { return {v.x, v.y, v.z}; }

SurfaceSample decoded_at(const Planes& planes, uint x, uint y) {
    SurfaceSample s;
    s.position = to_glm(planes.vector(SURFACE_POSITION, x, y));
    s.normal = to_glm(planes.vector(SURFACE_NORMAL, x, y));
    s.albedo = to_glm(planes.vector(SURFACE_ALBEDO, x, y));
    s.emissive = to_glm(planes.vector(SURFACE_EMISSIVE, x, y));
    s.roughness = planes.at(SURFACE_ROUGHNESS, x, y);
    s.metallic = planes.at(SURFACE_METALLIC, x, y);
    s.occlusion = planes.at(SURFACE_OCCLUSION, x, y);
    s.kind = SurfaceKind::lit;
    return s;
}

// What clusters of the pixel's tile list for it.
std::span<const uint> list_at(const Exposure& e, uint x, uint y) {
    const View& view = e.planes.view;
    const uint slice = fine_slice_of_depth(e.grid, e.planes.at(SURFACE_DEPTH, x, y));
    const ActiveCluster* cluster = e.lists.find(fine_tile(view, x, y), slice);
    return cluster == nullptr ? std::span<const uint>() : e.lists.refined_of(*cluster);
}

}  // namespace

Shot noise_shot(const ViewShape& shape, const DepthOf& depth, const KernelFeatures& features) {
    Shot shot;
    shot.features = features;
    shot.image = make_synthetic(make_view(shape), features, depth);
    return shot;
}

KernelFeatures every_feature(int shading) {
    KernelFeatures features;
    features.shading = shading;
    features.material = features.metallic = features.occlusion = true;
    features.spot_lights = features.directional_lights = true;
    return features;
}

void put_out_surfaces(Shot& shot) {
    shot.ambient = 0.0f;
    auto* material = shot.image.plane<uint>(PLANE_MATERIAL);
    const std::size_t pixels = std::size_t{shot.image.view.stride} * shot.image.view.height;
    for (std::size_t i = 0; i < pixels; ++i) material[i] &= 0xff000000u;
}

bool is_drawn(const Shot& shot, uint x, uint y) {
    const auto* depth = reinterpret_cast<const float*>(shot.image.bytes.data() +
                                                       shot.image.layout.offset_bytes[PLANE_DEPTH]);
    return depth[y * shot.image.view.stride + x] > 0.0f;
}

std::string at_pixel(uint x, uint y) {
    return "pixel " + std::to_string(x) + ", " + std::to_string(y);
}

Exposure expose(const Gpu& gpu, const Shot& shot) {
    return expose(gpu, shot, default_tuning(gpu.info));
}

Exposure expose(const Gpu& gpu, const Shot& shot, const Tuning& tuning) {
    const View& view = shot.image.view;
    Exposure out;
    out.grid = make_cluster_grid(shot.request, view.width, view.height);
    const GBuffer gbuffer = upload_gbuffer(gpu, shot.image);
    out.planes = decode(gpu, shot.features, gbuffer);
    StageRun stages(gpu, tuning, shot.features);
    Shade shade(gpu, tuning, shot.features);
    shade.set_ambient(shot.ambient);
    ShadeAll shade_all(gpu, tuning, shot.features);
    shade_all.set_ambient(shot.ambient);
    const DeviceLists lists =
        stages.run(upload_lights(gpu, shot.lights, shot.suns), gbuffer, out.grid);
    StageTimer timer;
    const std::size_t size = std::size_t{3} * view.stride * view.height;
    const Radiance listed =
        shade.enqueue(gbuffer, lists.lights, out.grid, lists.clusters, lists.refined, timer);
    out.listed = download<float>(gpu, listed.planes, size);
    out.all = download<float>(gpu, shade_all.enqueue(gbuffer, lists.lights, timer).planes, size);
    out.lists = download_lists(gpu, shot.features, out.grid, lists);
    out.lights = download<ShadeLight>(gpu, lists.lights.lights, shot.lights.size());
    out.extents = download<LightExtent>(gpu, lists.lights.extents, shot.lights.size());
    out.suns = download<DirectionalLight>(gpu, lists.lights.directional, shot.suns.size());
    return out;
}

Worst different_bits(const std::vector<float>& a, const std::vector<float>& b) {
    Worst worst;
    std::uint64_t different = a.size() == b.size() ? 0 : 1;
    std::string first = different > 0 ? "sizes differ" : "";
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (std::bit_cast<uint>(a[i]) == std::bit_cast<uint>(b[i])) continue;
        if (different++ == 0) {
            first = "value " + std::to_string(i) + ": " + std::to_string(a[i]) + ", " +
                    std::to_string(b[i]);
        }
    }
    worst.see(static_cast<double>(different), [&] { return first; });
    worst.checked = a.size();
    return worst;
}

void check_exact(Findings& findings, const Shot& shot, const Exposure& e) {
    findings.at_most("bits of lists against all lights", different_bits(e.listed, e.all), 0.0);
    const View& view = shot.image.view;
    Worst background;
    Worst number;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.stride; ++x) {
            const bool drawn = x < view.width && is_drawn(shot, x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                const float value = e.listed[c * plane + std::size_t{y} * view.stride + x];
                const auto place = [&] { return at_pixel(x, y); };
                if (!drawn) background.see(std::bit_cast<uint>(value) == 0 ? 0.0 : 1.0, place);
                if (drawn) number.see(std::isfinite(value) && value >= 0.0f ? 0.0 : 1.0, place);
            }
        }
    }
    findings.at_most("background not 0", background, 0.0);
    findings.at_most("NaN, Inf or negative", number, 0.0);
}

std::uint64_t check_none_missing(Findings& findings, const Shot& shot, const Exposure& e,
                                 std::size_t pixel_limit) {
    std::vector<uint> pixels = drawn_pixels(shot);
    const View& view = shot.image.view;
    const std::size_t step = std::max<std::size_t>(pixels.size() / pixel_limit, 1);
    std::uint64_t missed = 0;
    std::uint64_t tested = 0;
    std::uint64_t reaching = 0;
    std::string where;
    std::vector<bool> listed;
    for (std::size_t i = 0; i < pixels.size(); i += step) {
        const uint x = pixels[i] % view.width;
        const uint y = pixels[i] / view.width;
        listed.assign(shot.lights.size(), false);
        for (const uint light : list_at(e, x, y)) listed[light] = true;
        const Vec3d p = e.planes.vector(SURFACE_POSITION, x, y);
        for (std::size_t light = 0; light < shot.lights.size(); ++light) {
            ++tested;
            if (!reaches(e.lights[light], shot.lights[light].position_range.w, p)) continue;
            ++reaching;
            if (listed[light]) continue;
            if (missed++ == 0) where = "light " + std::to_string(light) + ", " + at_pixel(x, y);
        }
    }
    findings.none("missed lights", missed, tested, where);
    return reaching;
}

SurfaceSamples decoded_surfaces(const Shot& shot, const Exposure& e) {
    const View& view = shot.image.view;
    SurfaceSamples out =
        make_surface_samples(static_cast<int>(view.width), static_cast<int>(view.height));
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            if (!is_drawn(shot, x, y)) continue;
            out.at(static_cast<int>(x), static_cast<int>(y)) = decoded_at(e.planes, x, y);
        }
    }
    return out;
}

ReferencePicture r1_picture(const Shot& shot, const Exposure& e) {
    ReferenceOptions options;
    options.shading = model_of(shot.features.shading);
    options.ambient = shot.ambient;
    options.orthographic = shot.image.view.orthographic != 0;
    return shade_reference(decoded_surfaces(shot, e), reference_lights(e.lights, e.suns), options);
}

Worst error_against_r1(const Shot& shot, const Exposure& e) {
    const ReferencePicture r1 = r1_picture(shot, e);
    const View& view = shot.image.view;
    const std::size_t plane = std::size_t{view.stride} * view.height;
    Worst worst;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t i = 3 * (std::size_t{y} * view.width + x) + c;
                const double found = e.listed[c * plane + std::size_t{y} * view.stride + x];
                const double expected = r1.radiance.rgb[i];
                const double scale = std::max(expected, r1.scale.rgb[i]);
                const double difference = std::abs(found - expected);
                worst.see(scale > 0.0 ? difference / scale : difference,
                          [&] { return at_pixel(x, y); });
            }
        }
    }
    return worst;
}

LightsPerPixel lights_per_pixel(const Shot& shot, const Exposure& e) {
    const View& view = shot.image.view;
    LightsPerPixel sum;
    const std::vector<uint> pixels = drawn_pixels(shot);
    for (const uint pixel : pixels) {
        const uint x = pixel % view.width;
        const uint y = pixel / view.width;
        const auto list = list_at(e, x, y);
        const Vec3d p = e.planes.vector(SURFACE_POSITION, x, y);
        sum.listed += static_cast<double>(list.size());
        for (const uint light : list) {
            sum.reaching += reaches(e.lights[light], shot.lights[light].position_range.w, p);
        }
    }
    const auto count = static_cast<double>(std::max<std::size_t>(pixels.size(), 1));
    return {sum.listed / count, sum.reaching / count};
}

void check_lists(Findings& findings, const Gpu& gpu, const Shot& shot, std::uint64_t least_pairs) {
    const Exposure exposure = expose(gpu, shot);
    const std::uint64_t reaching = check_none_missing(findings, shot, exposure);
    findings.tried("pairs that reach", reaching, least_pairs);
    check_exact(findings, shot, exposure);
}

}  // namespace kilolux
