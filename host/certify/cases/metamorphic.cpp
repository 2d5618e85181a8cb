// SPDX-License-Identifier: Apache-2.0
// Metamorphic tests: what a change of the input must do to the picture; they need no reference.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/certify/cases.h"
#include "kernels/shared/evaluate_modes.h"

namespace kilolux {
namespace {

constexpr int kSumBlock = 64;  // lights of a block of the sum: SUM_BLOCK_LOG2

LightingCase usual_case(int shading, uint light_count) {
    LightingCase input =
        noise_case(square_pixels(67, 35), noise_depth(0.4, 50.0, 0.1, 8), every_feature(shading));
    input.lights = random_lights(input.image.view, {.count = light_count, .spots = 0.4});
    input.directional_lights = {{{0.48f, 0.6f, 0.64f, 0.0f}, {0.5f, 0.6f, 0.7f, 0.0f}}};
    input.ambient = 0.05f;
    return input;
}

void scale_color(float4& color, int exponent) {
    color.x = std::ldexp(color.x, exponent);
    color.y = std::ldexp(color.y, exponent);
    color.z = std::ldexp(color.z, exponent);
}

void scale_intensities(LightingCase& input, int exponent) {
    for (Light& light : input.lights) scale_color(light.color_scale, exponent);
    for (DirectionalLight& l : input.directional_lights) scale_color(l.color, exponent);
}

// Guards against a picture that is black.
void check_lit(Findings& findings, const DeviceResult& result) {
    const auto lit = std::count_if(result.listed.begin(), result.listed.end(),
                                   [](float v) { return v > 1e-3f; });
    findings.at_least("lit values", static_cast<std::uint64_t>(lit), 1000);
}

// Distance of two floats that are not negative, in units of the last place.
double ulps_apart(float a, float b) {
    return std::abs(static_cast<double>(std::bit_cast<int>(a)) - std::bit_cast<int>(b));
}

// The world and its radii times 2^exponent.
LightingCase scaled_world(LightingCase input, int exponent) {
    const auto scale = [&](float v) { return std::ldexp(v, exponent); };
    for (Light& light : input.lights) {
        float4& p = light.position_range;
        p = {scale(p.x), scale(p.y), scale(p.z), scale(p.w)};
        scale_color(light.color_scale, 2 * exponent);
    }
    // 1/z = depth01 * depth.x, so the depth buffer keeps its values.
    float4& depth = input.image.view.depth;
    for (float* value : {&depth.x, &depth.y, &depth.z, &depth.w}) {
        *value = std::ldexp(*value, -exponent);
    }
    input.request.z_first = scale(input.request.z_first);
    input.request.z_last = scale(input.request.z_last);
    return input;
}

// Removes lights nearer to a pixel than `least`: the 1 cm within which the inverse square stops
// growing does not scale with the world.
void remove_near_lights(const Gpu& gpu, LightingCase& input, double least) {
    const Planes planes = decode(gpu, input.features, upload_gbuffer(gpu, input.image));
    const View& view = input.image.view;
    std::erase_if(input.lights, [&](const Light& light) {
        const glm::dvec3 p = view_from_world(view, xyz(light.position_range));
        double nearest = least;
        for_each_pixel(view, [&](uint x, uint y) {
            nearest = std::min(nearest, glm::length(planes.vector(SURFACE_POSITION, x, y) - p));
        });
        return nearest < least;
    });
}

// Case M5, mirror.

std::vector<SurfaceSample> random_surfaces(uint width, uint height) {
    std::vector<SurfaceSample> surfaces;
    Random random(5);
    for (uint i = 0; i < width * height; ++i) {
        const double z = random.log_uniform(1.0, 8.0);
        const double x = random.uniform(-0.8, 0.8) * z;
        SurfaceSample s = grey_surface({x, random.uniform(-0.6, 0.6) * z, -z});
        s.normal = random.direction();
        s.normal.z = std::abs(s.normal.z);
        s.albedo = {random.unit(), random.unit(), random.unit()};
        s.roughness = random.uniform(0.1, 1.0);
        s.metallic = random.below(2);
        s.specular = {random.unit(), random.unit(), random.unit()};
        s.specular_f90 = random.unit();
        s.coat = random.unit();
        s.coat_roughness = random.uniform(0.1, 1.0);
        s.coat_normal = s.normal;
        s.sheen = {random.unit(), random.unit(), random.unit()};
        s.sheen_roughness = random.uniform(0.1, 1.0);
        s.transmission = random.unit();
        s.tangent = glm::normalize(glm::cross(s.normal, random.direction()));
        s.anisotropy = random.unit();
        surfaces.push_back(s);
    }
    return surfaces;
}

constexpr uint kMirrorWidth = 64;

std::vector<SurfaceSample> mirrored(const std::vector<SurfaceSample>& surfaces) {
    std::vector<SurfaceSample> out = surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const std::size_t x = i % kMirrorWidth;
        SurfaceSample s = surfaces[i];
        s.position.x = -s.position.x;
        s.normal.x = -s.normal.x;
        s.coat_normal.x = -s.coat_normal.x;
        s.tangent.x = -s.tangent.x;
        out[i - x + (kMirrorWidth - 1 - x)] = s;
    }
    return out;
}

}  // namespace

void try_other_grids(const Gpu& gpu, Findings& findings) {
    LightingCase input = usual_case(SHADING_PBR, 500);
    const DeviceResult expected = light_on_device(gpu, input);
    check_lit(findings, expected);
    for (const GridRequest& request :
         {GridRequest{1, 1, 1, 0.1f, 0.1f, 0.0f}, GridRequest{64, 64, 64, 0.01f, 1e4f, 0.0f},
          GridRequest{3, 5, 2, 5.0f, 9.0f, 0.0f}, GridRequest{2, 1, 8, 0.3f, 60.0f, 0.0f, 64},
          GridRequest{3, 3, 3, 0.2f, 80.0f, 0.0f}}) {
        input.request = request;
        check_same_bits(findings, "bits changed by the grid", light_on_device(gpu, input).listed,
                        expected.listed);
    }
}

void try_idle_lights(const Gpu& gpu, Findings& findings) {
    LightingCase input = usual_case(SHADING_PBR, 300);
    const DeviceResult expected = light_on_device(gpu, input);
    check_lit(findings, expected);
    const auto idle_light = [](int i) {
        return i % 2 == 0 ? point_light({0, 0, 0}, 100.0, {0, 0, 0})
                          : point_light({1e6, 0, 0}, 10.0);
    };
    // Two whole blocks of the sum between others, which shift no other block; and more at the end.
    std::vector<Light> blocks;
    for (int i = 0; i < 2 * kSumBlock; ++i) blocks.push_back(idle_light(i));
    input.lights.insert(input.lights.begin() + kSumBlock, blocks.begin(), blocks.end());
    for (int i = 0; i < 372; ++i) input.lights.push_back(idle_light(i));
    check_same_bits(findings, "bits changed by idle lights", light_on_device(gpu, input).listed,
                    expected.listed);
}

void try_scaled_intensities(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        LightingCase input = usual_case(shading, 200);
        put_out_surfaces(input);
        const DeviceResult expected = light_on_device(gpu, input);
        check_lit(findings, expected);
        for (const int exponent : {-24, -3, 1, 30}) {
            LightingCase scaled = input;
            scale_intensities(scaled, exponent);
            std::vector<float> product = expected.listed;
            for (float& v : product) v = std::ldexp(v, exponent);
            check_same_bits(findings, "bits that are not the product's",
                            light_on_device(gpu, scaled).listed, product);
        }
    }
}

void try_scaled_world(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        LightingCase input = usual_case(shading, 300);
        constexpr int kMost = 5;
        remove_near_lights(gpu, input, 0.0101 * (1 << kMost));
        const DeviceResult expected = light_on_device(gpu, input);
        check_lit(findings, expected);
        findings.at_least("lights left", input.lights.size(), 100);
        for (const int exponent : {-kMost, -1, 3, 10}) {
            const LightingCase scaled = scaled_world(input, exponent);
            check_same_bits(findings, "bits changed by scale", light_on_device(gpu, scaled).listed,
                            expected.listed);
        }
    }
}

void try_mirror(const Gpu& gpu, Findings& findings) {
    const std::vector<SurfaceSample> surfaces = random_surfaces(kMirrorWidth, 24);
    LightingCase input = surface_case(surfaces, SHADING_PBR, kMirrorWidth);
    LightingCase mirror = surface_case(mirrored(surfaces), SHADING_PBR, kMirrorWidth);
    input.lights = mirror.lights = random_lights(
        input.image.view, {.count = 300, .z_far = 10.0, .range_min = 0.5, .spots = 0.4});
    for (Light& light : mirror.lights) {
        light.position_range.x = -light.position_range.x;
        light.axis_cos.x = -light.axis_cos.x;
    }
    const DeviceResult a = light_on_device(gpu, input);
    const DeviceResult b = light_on_device(gpu, mirror);
    check_lit(findings, a);
    Worst worst;
    for (std::size_t i = 0; i < a.listed.size(); ++i) {
        const std::size_t x = i % kMirrorWidth;
        worst.add(ulps_apart(a.listed[i], b.listed[i - x + (kMirrorWidth - 1 - x)]),
                  [&] { return fmt::format("value {}", i); });
    }
    findings.at_most("ulp apart", worst, 2.0);
}

void try_split_light(const Gpu& gpu, Findings& findings) {
    for (const int shading : {SHADING_LAMBERT, SHADING_PBR}) {
        LightingCase input = usual_case(shading, 200);
        put_out_surfaces(input);
        const DeviceResult expected = light_on_device(gpu, input);
        for (const std::size_t split : {std::size_t{0}, std::size_t{63}, std::size_t{150}}) {
            LightingCase halves = input;
            scale_color(halves.lights[split].color_scale, -1);
            halves.lights.insert(halves.lights.begin() + static_cast<std::ptrdiff_t>(split),
                                 halves.lights[split]);
            const DeviceResult found = light_on_device(gpu, halves);
            const double k =
                static_cast<double>(halves.lights.size() + halves.directional_lights.size());
            Worst worst;
            for (std::size_t i = 0; i < found.listed.size(); ++i) {
                worst.add(ulps_apart(found.listed[i], expected.listed[i]) / (2.0 * k),
                          [&] { return fmt::format("value {}", i); });
            }
            findings.at_most("ulp apart / 2k", worst, 1.0);
        }
        check_lit(findings, expected);
    }
}

void try_permuted_lights(const Gpu& gpu, Findings& findings) {
    LightingCase input = usual_case(SHADING_LAMBERT, 1000);
    input.ambient = 0.0f;
    const DeviceResult expected = light_on_device(gpu, input);
    const ReferencePicture r1 = r1_picture(input, expected);
    // Both orders are within the bound of case 18 of the true sum.
    const double bound = 2.0 * (72.0 + 1001.0 / 64.0) * kUlp;
    std::mt19937 random(7);
    for (int order = 0; order < 3; ++order) {
        std::shuffle(input.lights.begin(), input.lights.end(), random);
        const DeviceResult found = light_on_device(gpu, input);
        Worst worst;
        std::size_t i = 0;
        for_each_pixel(input.image.view, [&](uint x, uint y) {
            for (std::size_t c = 0; c < 3; ++c, ++i) {
                const double scale = std::max(r1.scale.rgb[i], r1.radiance.rgb[i]);
                const double apart =
                    std::abs(double{found.radiance(x, y, c)} - expected.radiance(x, y, c));
                if (scale > 0.0) {
                    worst.add(apart / (bound * scale), [&] { return at_pixel(x, y); });
                }
            }
        });
        findings.at_most("apart / bound", worst, 1.0);
    }
    check_lit(findings, expected);
}

void try_lane_widths(const Gpu& gpu, Findings& findings) {
    const Gpu one = gpu.with_lanes(1);
    for (const int shading : {SHADING_LAMBERT, SHADING_BLINN_PHONG, SHADING_PBR}) {
        const LightingCase input = usual_case(shading, 500);
        const DeviceResult expected = light_on_device(one, input);
        const DeviceResult found = light_on_device(gpu, input);
        findings.require("the same lists", fingerprint(found.lists) == fingerprint(expected.lists));
        // OpenCL allows division and roots some ulp, and a GPU's compiler rounds them differently
        // for each width. The same bits at every width are promised on CPUs only.
        if (gpu.info.is_cpu) {
            check_same_bits(findings, "bits that differ from one lane's", found.listed,
                            expected.listed);
            check_same_bits(findings, "bits of all lights", found.all, expected.all);
            check_same_bits(findings, "bits of surfaces", found.planes.values,
                            expected.planes.values);
        }
        check_same_bits(findings, "bits of lists against all lights", found.listed, found.all);
        check_lit(findings, expected);
    }
}

}  // namespace kilolux
