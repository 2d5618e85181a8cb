// SPDX-License-Identifier: Apache-2.0
#include "host/certify/lighting_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "host/base/formats/gbuffer_layout.h"
#include "host/base/system/interrupt.h"
#include "host/gpu/buffer.h"
#include "host/measure/reference/decoded_samples.h"

namespace kilolux {
namespace {

// Whether the point is within the light's range and cone, in double.
bool reaches(const ShadeLight& light, double range, const glm::dvec3& p) {
    const glm::dvec3 v = p - xyz(light.position_inv_range2);
    const double d2 = glm::dot(v, v);
    if (d2 >= range * range) return false;
    const double cos_out = light.axis_cos.w;
    return cos_out <= -1.0 || glm::dot(v, xyz(light.axis_cos)) > cos_out * std::sqrt(d2);
}

void put_surface(Synthetic& image, uint x, uint y, const SurfaceSample& s) {
    const std::size_t pixel = std::size_t{y} * image.view.stride + x;
    image.put(PLANE_DEPTH, pixel, depth01_of(image.view, x, y, -s.position.z));
    image.put(PLANE_POSITION_X, pixel, s.position);
    image.put(PLANE_NORMAL_X, pixel, s.normal);
#define PUT_VALUE(has, member, decoded, plane, value) image.put(plane, pixel, s.member);
    SURFACE_VALUES(PUT_VALUE, PUT_VALUE)
#undef PUT_VALUE
}

// How far a position lies from its pixel's ray at its depth, along an axis.
double off_ray(const View& view, uint x, uint y, const glm::dvec3& p) {
    const glm::dvec3 off = glm::abs(position_at(view, x + 0.5, y + 0.5, -p.z) - p);
    return std::max(off.x, off.y) * (1.0 + 1e-5) + 1e-5 * std::abs(p.z);
}

}  // namespace

LightingCase noise_case(const ViewShape& shape, const DepthOf& depth,
                        const KernelFeatures& features) {
    LightingCase input;
    input.features = features;
    input.image = make_synthetic(make_view(shape), features, depth);
    return input;
}

KernelFeatures every_feature(int shading) {
    KernelFeatures features;
    features.shading = shading;
    features.material = features.metallic = features.occlusion = features.specular = true;
    features.clearcoat = features.coat_normals = features.sheen = true;
    features.anisotropy = features.transmission = true;
    features.spot_lights = features.directional_lights = true;
    return features;
}

void put_out_surfaces(LightingCase& input) {
    input.ambient = 0.0f;
    auto* material = input.image.plane<uint>(PLANE_MATERIAL);
    const std::size_t pixels = std::size_t{input.image.view.stride} * input.image.view.height;
    for (std::size_t i = 0; i < pixels; ++i) material[i] &= 0xff000000u;
}

std::string at_pixel(uint x, uint y) { return fmt::format("pixel {}, {}", x, y); }

SurfaceSample grey_surface(const glm::dvec3& position, const glm::dvec3& normal) {
    SurfaceSample s;
    s.position = position;
    s.normal = normal;
    s.albedo = glm::dvec3(0.5);
    s.roughness = 0.5;
    s.kind = SurfaceKind::lit;
    return s;
}

LightingCase surface_case(std::span<const SurfaceSample> surfaces, int shading, uint width) {
    const auto count = static_cast<uint>(surfaces.size());
    ViewShape shape{width, std::max((count + width - 1) / width, 1u)};
    shape.rotated = false;
    shape.near = 1e-3;
    const View view = make_view(shape);
    LightingCase input;
    input.features = every_feature(shading);
    input.features.gbuffer = GBUFFER_FULL;
    input.features.directional_lights = false;
    input.features.light_index_bits = 32;
    const GBufferNeeds needs{input.features, GBUFFER_FULL, 1.0f};
    input.image = {view, make_gbuffer_layout(needs, view.stride, view.height), {}};
    input.image.bytes.resize(gbuffer_bytes(input.image.layout, view.stride, view.height));
    double pad = 0.0;
    for (uint i = 0; i < count; ++i) {
        put_surface(input.image, i % width, i / width, surfaces[i]);
        pad = std::max(pad, off_ray(view, i % width, i / width, surfaces[i].position));
    }
    input.request.position_pad = static_cast<float>(pad);
    return input;
}

ClusterGrid grid_of(const LightingCase& input) {
    return make_cluster_grid(input.request, input.image.view.width, input.image.view.height);
}

LightingInput upload(const Gpu& gpu, const LightingCase& input) {
    return {upload_gbuffer(gpu, input.image),
            upload_lights(gpu, input.lights, input.directional_lights), grid_of(input)};
}

std::vector<float> download(const Gpu& gpu, const Radiance& radiance) {
    const View& view = radiance.view;
    return download<float>(gpu, radiance.planes, std::size_t{3} * view.stride * view.height);
}

DeviceResult light_on_device(const Gpu& gpu, const LightingCase& input) {
    check_interrupt();
    const Tuning tuning = default_tuning(gpu.info);
    const LightingInput uploaded = upload(gpu, input);
    DeferredLighting lighting(gpu, tuning, input.features);
    AllLightsLighting all_lights(gpu, tuning, input.features);
    lighting.set_ambient(input.ambient);
    all_lights.set_ambient(input.ambient);
    StageTimer timer;
    DeviceResult out;
    out.grid = uploaded.grid;
    out.planes = decode(gpu, input.features, uploaded.gbuffer);
    out.listed = download(gpu, lighting.light(uploaded, timer));
    out.all = download(gpu, all_lights.enqueue(uploaded, timer));
    const ListedLights& lists = lighting.lists();
    out.lists = download_lists(gpu, input.features, lists);
    out.lights = download<ShadeLight>(gpu, lists.lights.lights, input.lights.size());
    out.extents = download<LightExtent>(gpu, lists.lights.extents, input.lights.size());
    out.directional_lights =
        download<DirectionalLight>(gpu, lists.lights.directional, input.directional_lights.size());
    return out;
}

std::uint64_t count_lit(const std::vector<float>& values) {
    return values.size() - static_cast<std::size_t>(std::ranges::count(values, 0.0f));
}

std::uint64_t count_invalid(const std::vector<float>& values) {
    const auto invalid = [](float v) { return !std::isfinite(v) || v < 0.0f; };
    return static_cast<std::uint64_t>(std::ranges::count_if(values, invalid));
}

Worst different_bits(const std::vector<float>& a, const std::vector<float>& b) {
    std::uint64_t different = a.size() == b.size() ? 0 : 1;
    std::string first = different > 0 ? "sizes differ" : "";
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (std::bit_cast<uint>(a[i]) == std::bit_cast<uint>(b[i])) continue;
        if (different++ == 0) {
            first = fmt::format("value {}: {:f}, {:f}", i, a[i], b[i]);
        }
    }
    return {static_cast<double>(different), a.size(), first};
}

void check_same_bits(Findings& findings, std::string_view what, const std::vector<float>& a,
                     const std::vector<float>& b) {
    findings.at_most(what, different_bits(a, b), 0.0);
}

void check_exact(Findings& findings, const LightingCase& input, const DeviceResult& result) {
    check_same_bits(findings, "bits of lists against all lights", result.listed, result.all);
    Worst background;
    Worst number;
    for (uint y = 0; y < input.image.view.height; ++y) {
        for (uint x = 0; x < input.image.view.stride; ++x) {
            const bool drawn = x < input.image.view.width && input.image.shows_surface(x, y);
            const auto place = [&] { return at_pixel(x, y); };
            for (std::size_t c = 0; c < 3; ++c) {
                const float v = result.radiance(x, y, c);
                const bool valid =
                    drawn ? std::isfinite(v) && v >= 0.0f : std::bit_cast<uint>(v) == 0;
                (drawn ? number : background).add(valid ? 0.0 : 1.0, place);
            }
        }
    }
    findings.at_most("background not 0", background, 0.0);
    findings.at_most("NaN, Inf or negative", number, 0.0);
}

std::uint64_t check_none_missing(Findings& findings, const LightingCase& input,
                                 const DeviceResult& result, std::size_t pixel_limit) {
    const std::vector<uint> pixels = input.image.surface_pixels();
    const uint width = input.image.view.width;
    const std::size_t step = std::max<std::size_t>(pixels.size() / pixel_limit, 1);
    Worst missed;
    std::uint64_t reaching = 0;
    std::vector<bool> listed;
    for (std::size_t i = 0; i < pixels.size(); i += step) {
        const uint x = pixels[i] % width;
        const uint y = pixels[i] / width;
        listed.assign(input.lights.size(), false);
        for (const uint light : result.lists.list_at(result.grid, result.planes, x, y))
            listed[light] = true;
        const glm::dvec3 p = result.planes.vector(SURFACE_POSITION, x, y);
        for (std::size_t light = 0; light < input.lights.size(); ++light) {
            const double range = input.lights[light].position_range.w;
            ++missed.checked;
            if (!reaches(result.lights[light], range, p)) continue;
            ++reaching;
            if (listed[light]) continue;
            if (missed.value++ == 0.0) {
                missed.where = fmt::format("light {}, {}", light, at_pixel(x, y));
            }
        }
    }
    findings.at_most("missed lights", missed, 0.0);
    return reaching;
}

DeviceResult check_lists(Findings& findings, const Gpu& gpu, const LightingCase& input,
                         std::uint64_t least_pairs) {
    DeviceResult result = light_on_device(gpu, input);
    const std::uint64_t reaching = check_none_missing(findings, input, result);
    findings.at_least("pairs that reach", reaching, least_pairs);
    check_exact(findings, input, result);
    return result;
}

SurfaceSamples decoded_surfaces(const LightingCase& input, const DeviceResult& result) {
    const View& view = input.image.view;
    SurfaceSamples out =
        make_surface_samples(static_cast<int>(view.width), static_cast<int>(view.height));
    for_each_drawn(input, [&](uint x, uint y) {
        out.at(static_cast<int>(x), static_cast<int>(y)) = surface_sample(
            [&](std::size_t plane) { return result.planes.at(static_cast<uint>(plane), x, y); },
            false);
    });
    return out;
}

ReferencePicture r1_picture(const LightingCase& input, const DeviceResult& result) {
    return shade_reference(decoded_surfaces(input, result),
                           reference_lights(result.lights, result.directional_lights),
                           {.shading = shading_of(input.features),
                            .ambient = input.ambient,
                            .orthographic = input.image.view.orthographic != 0});
}

Worst error_against_r1(const LightingCase& input, const DeviceResult& result) {
    const ReferencePicture r1 = r1_picture(input, result);
    Worst worst;
    std::size_t i = 0;
    for_each_pixel(input.image.view, [&](uint x, uint y) {
        for (std::size_t c = 0; c < 3; ++c, ++i) {
            const double expected = r1.radiance.rgb[i];
            const double scale = std::max(expected, r1.scale.rgb[i]);
            const double difference = std::abs(result.radiance(x, y, c) - expected);
            worst.add(scale > 0.0 ? difference / scale : difference,
                      [&] { return at_pixel(x, y); });
        }
    });
    return worst;
}

double useful_share(const LightingCase& input, const DeviceResult& result) {
    double listed = 0.0;
    double reaching = 0.0;
    for_each_drawn(input, [&](uint x, uint y) {
        const auto list = result.lists.list_at(result.grid, result.planes, x, y);
        const glm::dvec3 p = result.planes.vector(SURFACE_POSITION, x, y);
        listed += static_cast<double>(list.size());
        for (const uint light : list) {
            reaching += reaches(result.lights[light], input.lights[light].position_range.w, p);
        }
    });
    return reaching / listed;
}

}  // namespace kilolux
